"""The shadow depth of a ray without a hit."""

# t_pred of a ray without shadow: a diameter, the upper bound of min(s, ℓ). Not ℓ itself: computed
# from o and d it differs from the point's own ℓ by a rounding, and without a depth bias a tenth of
# the points behind a miss were in shadow.
LIT = 2.0
