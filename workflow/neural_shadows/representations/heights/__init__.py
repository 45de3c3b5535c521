"""Heights of a landscape over a grid."""
