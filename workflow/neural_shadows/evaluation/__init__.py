"""Every method on the same viewpoints: quality, time, memory, cost [4]."""
