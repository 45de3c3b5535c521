"""Where each result lies, and which part of the work each job does."""
