"""Experiments: names, sections of their own, labels."""

from neural_shadows.config.experiments import formatted, network_of, seed_of, training_of
from neural_shadows.config.reading import read_config


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
