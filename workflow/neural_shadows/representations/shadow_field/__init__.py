"""Fields of a mesh's distances that answer shadow rays: fitted, saved, queried."""
