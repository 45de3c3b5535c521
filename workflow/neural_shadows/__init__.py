"""Neural Shadow Ray Queries: the stages of the experiment pipeline."""
