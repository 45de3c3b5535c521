"""An optimiser on a network's loss: resumable, reproducible from its seed [3.5, 4.1]."""
