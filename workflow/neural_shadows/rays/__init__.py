"""Training rays: directions, silhouettes, quadtrees, points, labels; ray sets on disk [3.4]."""
