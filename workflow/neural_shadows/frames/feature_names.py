"""The channels that a screen-space network may be given, by name (Datta et al. 2022, 3.1, 3.2)."""

# Channels of each feature, 15 in all: cosine with the way to the light, and the light's size; cosine
# with the way to the eye over the distance from it; shadow map's depth over the point's distance
# from the light, and their difference; cosine between the point's normal and the one that the light
# sees; depth along the camera's axis; normal; the map's depth and normal; distance from the light;
# cosine with the way to the eye.
FEATURES = {
    **{"c_e": 1, "view": 1, "ratio": 1, "difference": 1, "agreement": 1, "d": 1},
    **{"n": 3, "z": 1, "n_e": 3, "z_f": 1, "c_c": 1},
}
