"""Networks, trained or not, and their weight files [3.3, 3.6]."""
