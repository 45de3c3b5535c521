"""Shadow methods on views and frames: constants, errors, times, memory."""
