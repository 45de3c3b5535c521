"""Networks of whole frames, from buffers to visibility (Datta et al. 2022)."""
