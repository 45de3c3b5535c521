"""Screen-space networks, from buffers to visibility (Datta et al. 2022)."""
