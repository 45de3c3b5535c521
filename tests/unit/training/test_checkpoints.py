"""States of trainings go when the networks are there, and only then."""

from neural_shadows.training.checkpoints import UNFINISHED, forget_finished


def test_states_of_finished_networks_are_forgotten(tmp_path):
    states = [tmp_path / UNFINISHED / name for name in ("dragon-1a", "dragon-2b", "dragon_64-3c")]
    states.append(tmp_path / UNFINISHED / "fence-4d")
    for state in states:
        state.mkdir(parents=True)
        (state / "state.safetensors").write_text("state")
    for name in ("dragon", "other"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "weights.safetensors").write_text("weights")
    (tmp_path / "fence").mkdir()  # Snakemake makes it before the training
    forget_finished(tmp_path)
    assert [state.exists() for state in states] == [False, False, True, True]
    assert (tmp_path / "dragon" / "weights.safetensors").exists()


def test_without_states(tmp_path):
    forget_finished(tmp_path)
    forget_finished(tmp_path / "results" / "networks")
    assert list(tmp_path.iterdir()) == []
