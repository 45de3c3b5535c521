"""From a mesh file, made, fetched or the user's, to a clean mesh in its unit sphere [3.3.1]."""
