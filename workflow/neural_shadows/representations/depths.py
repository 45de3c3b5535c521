"""The shadow depth of a ray without a hit."""

# t_pred of a ray without shadow: a diameter, which no point's min(s, ℓ) exceeds. Not ℓ itself:
# found from o and d it differs from the point's own ℓ by a rounding, and without a depth bias a
# tenth of the points behind a ray that misses were in shadow.
LIT = 2.0
