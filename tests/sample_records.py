"""Records as the stages write them, for the tests of what reads them."""

MACHINE = {"cpu": "a CPU", "cores": 2, "gpu": None, "system": "Linux"}
TRAINING = {
    "name": "dragon",
    "network": {"encoding": "frequency", "frequencies": 2, "width": 8, "hidden_layers": 2},
    "training": {
        "steps": 10,
        "batch_size": 64,
        "learning_rate": 0.1,
        "schedule": "constant",
        "device": "cpu",
        "precision": "float32",
    },
    "parameters": 100,
    "samples": 640,
    "seconds": 1.5,
    "machine": MACHINE,
    "threads": 2,
}
FRAME_TIMES = {
    "scene": "dragon",
    "width": 60,
    "height": 40,
    "view_sets": ["shadow"],
    "views": 4,
    "repeats": 2,
    "warm_up": 1,
    "device": "cpu",
    "precision": "float32",
    "machine": MACHINE,
    "sphere_rays": 123.0,
    "methods": {"ray_traced": {"ms": [1.5, 2.5]}, "dragon": {"ms": [0.5, 1.5]}},
    "rays_per_second": {"dragon": [1e6, 2e6]},
}
COST = {
    "over": "samples",
    "size": 1000,
    "stages": [{"stage": "rays", "seconds": 1.5, "bytes": 10, "peak_bytes": 20}],
    "machine": MACHINE,
    "threads": 2,
}
LPIPS = {"net": "alex", "trunk": None, "available": False, "reason": "offline"}
MESH = {
    "name": "thing",
    "source": "thing.ply",
    "sha256": "0" * 64,
    "centre": [1.0, 2.0, 3.0],
    "radius": 4.0,
    "vertices": 4,
    "faces": 4,
    "watertight": True,
}
