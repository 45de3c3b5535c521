"""Methods for shadows, hard and soft, on the same frames; workflow/README.md has the rooms."""
