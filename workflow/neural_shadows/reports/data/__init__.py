"""What tables, figures, claims and the page share: measured and printed numbers, words, looks."""
