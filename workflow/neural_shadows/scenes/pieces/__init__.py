"""Parts of generated scenes: furniture, buildings, gardens, floor plans."""
