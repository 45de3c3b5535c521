"""Networks of one object: from rays to shadow depths."""
