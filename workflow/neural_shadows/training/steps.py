"""Steps of a training, with checkpoints and progress."""

import time
from collections.abc import Callable
from pathlib import Path

from neural_shadows.files.whole_files import write_text
from neural_shadows.running.progress import progress_bar, warn
from neural_shadows.training.checkpoints import STATE
from neural_shadows.training.training_state import TrainingState

# Points of the loss curve, each the mean loss since the point before.
CURVE_POINTS = 500

# Between checkpoints. A kill costs at most these and one point of the loss curve, 1/500 of the run.
CHECKPOINT_SECONDS = 30.0


def train_to_end(
    run: TrainingState,
    advance: Callable[[], object],
    name: str,
    checkpoint: Path,
    started: float,
    samples: str = "samples",
    at_point: Callable[[int], object] = lambda step: None,
) -> None:
    """Do the remaining steps, with checkpoints and progress.

    The run's seconds count from `started` on the monotonic clock.

    Args:
        advance: does one step.
        samples: unit of the progress bar, a plural.
        at_point: called with the steps at each point of the loss curve, before a checkpoint.
    """
    seconds_before, last_saved = run.seconds, started
    steps = run.settings["steps"]
    point_interval = max(1, steps // CURVE_POINTS)
    step = saved_step = int(run.step)
    total, done = steps * run.samples_a_step, step * run.samples_a_step
    with progress_bar(total, samples, f"train {name}", done) as bar:
        while step < steps and run.died_at_step is None:
            advance()
            step += 1
            bar.update(run.samples_a_step)
            if step % point_interval != 0 and step < steps:
                continue
            # Checkpoints are written at points of the curve only: a restored run then has no partial
            # loss sum, and only there a GPU is waited for.
            run.add_point()
            at_point(step)
            bar.set_postfix(loss=f"{run.curve[-1][2]:.4g}", refresh=False)
            run.seconds = seconds_before + time.monotonic() - started
            if time.monotonic() - last_saved > CHECKPOINT_SECONDS:
                run.save(checkpoint / STATE)
                write_text(checkpoint / "loss.csv", run.curve_csv())
                last_saved, saved_step = time.monotonic(), step
    if run.died_at_step is not None:
        warn(
            f"training {name} diverged at step {run.died_at_step}: its loss is not finite, "
            "or its output is the same everywhere. Its weights are written as they are. Set a lower "
            "`learning_rate` or another `seed`."
        )
    if 0 < saved_step < step:
        run.save(checkpoint / STATE)
