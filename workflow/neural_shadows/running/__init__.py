"""Jobs: stage calls, logs, progress, and module dependencies."""
