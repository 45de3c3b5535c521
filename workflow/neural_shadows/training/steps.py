"""The steps of a training from where it stands to its end, with checkpoints and progress."""

import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from neural_shadows.files.whole_files import write_text
from neural_shadows.running.progress import progress_bar
from neural_shadows.training.checkpoints import STATE
from neural_shadows.training.training_state import TrainingState

# Points of the loss curve, each the mean loss since the point before.
CURVE_POINTS = 500

# Between checkpoints. A kill costs at most that and one point of the loss curve, 1/500 of the run.
CHECKPOINT_SECONDS = 30.0

Points = Callable[[Callable[[int], object]], Iterator[int]]
"""Does the steps that are left; takes who is told of each step's samples, gives `curve_points`."""


def curve_points(
    run: TrainingState, advance: Callable[[], None], after_step: Callable[[int], object]
) -> Iterator[int]:
    """Do the steps that are left, and give the number of steps at each point of the loss curve.

    Args:
        advance: does one step.
        after_step: told of the samples of each step.
    """
    steps = run.settings["steps"]
    point_interval = max(1, steps // CURVE_POINTS)
    step = int(run.step)
    while step < steps and run.died_at_step is None:
        advance()
        step += 1
        after_step(run.samples_a_step)
        if step % point_interval == 0 or step == steps:
            run.add_point()
            yield step


def train_to_end(
    run: TrainingState,
    points: Points,
    name: str,
    checkpoint: Path,
    started: float,
    samples: str = "samples",
) -> None:
    """Do the steps that are left; the run's seconds count from `started` on the monotonic clock.

    Args:
        samples: what a step has many of, a plural.
    """
    seconds_before, last_saved = run.seconds, started
    step = saved_step = int(run.step)
    total, done = run.settings["steps"] * run.samples_a_step, step * run.samples_a_step
    with progress_bar(total, samples, f"train {name}", done) as bar:
        # Checkpoints are written at points of the curve only, so that a restored run has no
        # half-summed loss to carry along; and only there a GPU is waited for.
        for step in points(bar.update):
            bar.set_postfix(loss=f"{run.curve[-1][2]:.4g}", refresh=False)
            run.seconds = seconds_before + time.monotonic() - started
            if time.monotonic() - last_saved > CHECKPOINT_SECONDS:
                run.save(checkpoint / STATE)
                write_text(checkpoint / "loss.csv", run.curve_csv())
                last_saved, saved_step = time.monotonic(), step
    if run.died_at_step is not None:
        print(
            f"warning: training {name} died at step {run.died_at_step}: its loss is not finite, "
            "or it answers the same to everything; its weights are written as they are. A lower "
            "`learning_rate` in the config, or another `seed`, may keep it alive",
            file=sys.stderr,
        )
    if 0 < saved_step < step:
        run.save(checkpoint / STATE)
