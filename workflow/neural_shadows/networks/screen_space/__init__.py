"""Networks that answer a whole frame from its buffers (Datta et al. 2022)."""
