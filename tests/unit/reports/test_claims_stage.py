import pytest
from claim_samples import better, loss_curve, pairs, points
from report_samples import (
    SCENES,
    TRAINING,
    cells_of,
    write_mesh,
    write_metrics,
    write_record,
    written_table,
)

from neural_shadows.evaluation.violations import RANDOM
from neural_shadows.reports.claims.kinds.violations import COUNTS
from neural_shadows.reports.claims.write_claims import COLUMNS, claims
from neural_shadows.reports.data.quality import METRICS
from neural_shadows.reports.page.claim_cards import budget, read_cards

CURVE = points("net", [20_480_000], 3)
THESIS = {"text": "thesis", "section": "4", "statement": "So."}
CLAIMS = {
    "quality": better(("net", "shadow_map_256"), metrics=["lpips", "psnr"], seeds=3, budget=0.03),
    "own_mesh": better(("net", "shadow_map_256"), mesh="thesis"),
    "loss": better(("net", "other"), metrics=["loss"]),
    "time": {"kind": "frame_time", "table": "t", "rows": pairs(("net", "shadow_map_256"))}
    | {"at_least": 1, "at_most": None, "overhead_ms": 0.0, "needs": {"device": "cpu"}},
    "printed": {"kind": "printed", "table": "4.4", "pairs": [["network", "shadow_map_128"]]}
    | {"metrics": ["psnr"]},
}


@pytest.fixture
def written(tmp_path):
    """Claims on a network of three seeds and its baselines."""
    runs = [point["experiment"] for point in CURVE]
    quality = dict.fromkeys(METRICS, 0.2) | {"psnr": 20.0, "ssim": 0.9}
    means = dict.fromkeys(runs, quality)
    means["shadow_map_256"] = {name: value / 2 for name, value in quality.items()}
    means["no_shadow"] = quality | {"lpips": 0.5, "psnr": 10.0, "ssim": 0.5}
    means[runs[0]] = means[runs[0]] | dict.fromkeys(
        (*COUNTS, *(RANDOM + name for name in COUNTS)), 1.0
    )
    folder = tmp_path / "networks"
    losses, trainings = [], []
    for seed, name in enumerate([*runs, "other"]):
        training = TRAINING["training"] | {"steps": 20_000, "batch_size": 1024, "seed": seed % 3}
        ended = {"training": training, "samples": 20_480_000, "no_shadow_loss": 0.7}
        trainings.append(write_record(folder / name / "training.json", TRAINING | ended))
        losses.append(trainings[-1].with_name("loss.csv"))
        curve = loss_curve(0.6 if name == "other" else 0.1).rename_axis("step").reset_index()
        curve.assign(samples=1, learning_rate=0.1).to_csv(losses[-1], index=False)
    frames = {"own_ms": [2.0] * 15, "ms": [3.0] * 15, "device": "cpu"}
    timed = {"net": frames, "shadow_map_256": frames | {"own_ms": [1.0] * 15}}
    times = write_record(tmp_path / "frame_times" / "t" / "dragon.json", {"methods": timed})
    return written_table(
        claims,
        tmp_path,
        metrics=[write_metrics(tmp_path, means, views=24)],
        losses=losses,
        trainings=trainings,
        times=[times],
        meshes=[write_mesh(tmp_path)],
        claims={name: THESIS | claim for name, claim in CLAIMS.items()},
        learning_curves={"net": CURVE},
        soft_metrics=[],
        soft_times=[],
        soft_tables={},
    )


def test_claims_are_written_with_verdict_reason_and_scale(written):
    rows, _ = written
    assert list(rows) == COLUMNS
    verdicts = rows.set_index("claim")["verdict"]
    assert verdicts.to_dict() == {
        "quality": "undecided (scale)",
        "own_mesh": "not comparable",
        "loss": "undecided (scale)",
        "time": "supported",
        "printed": "contradicted",
    }
    first = rows.iloc[0]
    assert (first["metric"], first["seeds"], first["null_verdict"]) == (
        "lpips, psnr",
        3,
        "contradicted",
    )
    assert first["budget_fraction"] == pytest.approx(1 / 3200)
    assert (first["samples"], first["text_samples"]) == (20_480_000, 65_536_000_000)
    assert rows["kind"].tolist() == ["better", "better", "better", "frame_time", "printed"]
    assert rows["samples"].isna().tolist() == [False, False, False, True, True]


def test_a_reader_meets_the_scale_and_the_meanings_before_the_first_verdict(written):
    _, md = written
    text = md.read_text()
    lead = text.split("| claim")[0]
    assert "20,480,000 training samples each in this run, and 65,536,000,000 in the thesis" in lead
    assert "3,200 times as many" in lead and "- **contradicted** (1): " in lead
    cells = cells_of(md, 0)
    assert (cells["verdict"], cells["why"][:32]) == (
        "**undecided (scale)**",
        "0.031 % of the thesis's samples,",
    )
    assert f"Mesh of dragon: {SCENES['dragon']['mesh_name']} (generated" in text


def test_screen_space_networks_are_trained_too(tmp_path):
    records = [
        write_record(tmp_path / str(samples) / "training.json", {"samples": samples})
        for samples in (500, 2000)
    ]
    nothing = "metrics losses trainings times meshes soft_metrics soft_times".split()
    settings = dict.fromkeys(nothing, []) | {"soft_tables": {}, "learning_curves": {}, "scenes": {}}
    settings |= {"claims": {"printed": THESIS | CLAIMS["printed"]}, "screen_trainings": records}
    _, md = written_table(claims, tmp_path, **settings)
    lead = "at most 2,000 pixels each in this run, and 62.9 billion and 168 billion in Datta et al."
    assert lead in md.read_text()


def test_the_page_shows_them_as_cards(written):
    _, md = written
    scale, *others = read_cards(md.with_suffix(".csv"))
    assert scale.verdict.style == "undecided-scale"
    assert scale.number.startswith("advantage in LPIPS: −0.1 [−0.") and scale.number.endswith(
        "(the least favourable of 2 comparisons)"
    )
    assert len(scale.evidence) == 2 and scale.evidence[0].startswith("LPIPS of net 0.2 against")
    assert {"not-comparable", "contradicted"} <= {card.verdict.style for card in others}
    assert budget(md.with_suffix(".csv")) == md.read_text().split("\n")[2].split(" A verdict")[0]
