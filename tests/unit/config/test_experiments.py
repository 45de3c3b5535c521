"""Experiments: names, sections of their own, labels."""

import pytest

from neural_shadows.config.experiments import formatted, network_of, seed_of, training_of
from neural_shadows.config.reading import read_config

MISTAKES = [
    ("dragon.scene", "dog", "experiments.dragon.scene: 'dog' is not among dragon, fence"),
    ("dragon.network", "thesi", "experiments.dragon.network: 'thesi' (did you mean 'thesis'?)"),
    ("dragon.network", {"frequencies": 1, "width": 7, "hidden_layers": 1}, "network.width = 7"),
    (
        "dragon.training",
        {"steps": 5, "batch_size": 16},
        "experiments.dragon.training.learning_rate: this key is",
    ),
    ("dragon.bias", "best", "experiments.dragon.bias = 'best': Input should be 'held_out'"),
    ("dragon.bias", 2, "experiments.dragon.bias = 2: Input should be less than or equal to 1"),
    ("dragon.label", "{depth}", "the label '{depth}' of dragon: what stands in braces"),
    ("dragon.label", "{", "the label '{' of dragon"),
    ("reference", {}, "experiments.reference: tables and pictures have a method of this name"),
    ("shadow_map_64", {}, "experiments.shadow_map_64: tables and pictures have a method"),
    ("dragon_biased", {}, "experiments.dragon_biased: tables and pictures have a method"),
    ("twin", {"label": "Twin"}, "experiments.twin: is the same as experiments.dragon"),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES, ids=lambda part: str(part)[:40])
def test_mistakes(message, values, key, value, words):
    if "." not in key:
        value = values["experiments"]["dragon"] | value
    assert words in message(f"experiments.{key}", value)


def test_sections_stand_inline_or_by_name(values):
    config = read_config(values)
    assert network_of(config, "dragon") is config.networks["thesis"]
    assert network_of(config, "dragon_5_frequencies").frequencies == 5
    assert training_of(config, "dragon") is config.trainings["base"]
    assert training_of(config, "ablation_half").steps == 1000


def test_labels_are_made_of_settings(values, shipped):
    config = read_config(values)
    assert formatted(config, "dragon_field") == "256³ occupancy field"
    assert formatted(read_config(shipped("smoke")), "dragon_field") == "64³ occupancy field"
    assert formatted(config, "dragon_low_rate") == "Learning rate 0.0001"
    assert formatted(config, "dragon", "{width} wide") == "256 wide"
    values["experiments"]["fence"].pop("label")
    assert formatted(read_config(values), "fence") == "fence"


def test_seeds(changed):
    config = read_config(changed("scenes.dragon.seed", 0))
    seeds = [seed_of(config, name) for name in ("fence", "dragon", "ablation_seed_1")]
    assert seeds == [2026, 0, 1]
