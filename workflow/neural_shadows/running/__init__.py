"""A job and a run, whatever they make: logs, records, progress, what must be run again."""
