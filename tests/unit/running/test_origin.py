import shutil
import subprocess

from checkout import ROOT

from neural_shadows.running.origin import CHECKOUT, commit_of, describe_origin


def git(folder, *arguments):
    identity = ["-c", "user.name=Test", "-c", "user.email=test@example.org"]
    command = ["git", *identity, "-C", folder, *arguments]
    return subprocess.check_output(command, text=True).strip()


def test_commit_is_named_and_changes_are_reported(tmp_path):
    assert commit_of(tmp_path) == "not a git checkout"
    git(tmp_path, "init", "--quiet")
    (tmp_path / "file").write_text("one")
    git(tmp_path, "add", "file")
    git(tmp_path, "commit", "--quiet", "-m", "first")
    git(tmp_path, "tag", "-a", "v1", "-m", "a release")
    head = git(tmp_path, "rev-parse", "HEAD")
    assert commit_of(tmp_path) == head
    (tmp_path / "mesh.ply").touch()
    (tmp_path / "config").mkdir()
    assert commit_of(tmp_path) == head
    # A user's own overlay is nobody's commit.
    (tmp_path / "config/mine.yaml").touch()
    assert commit_of(tmp_path) == f"{head} with uncommitted changes"
    (tmp_path / "config/mine.yaml").unlink()
    (tmp_path / "file").write_text("two")
    assert commit_of(tmp_path) == f"{head} with uncommitted changes"


def test_a_folder_within_another_repository_is_no_checkout_of_it(tmp_path):
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "commit", "--quiet", "--allow-empty", "-m", "first")
    (tmp_path / "copy").mkdir()
    assert commit_of(tmp_path / "copy") == "not a git checkout"


def test_an_archive_has_its_commit(tmp_path):
    """As a release's download, by the files of this checkout."""
    for name in (".gitattributes", "workflow/COMMIT"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "--quiet", "-m", "first")
    git(tmp_path, "archive", "--output", "archive.tar", "HEAD")
    shutil.unpack_archive(tmp_path / "archive.tar", tmp_path / "archive")
    assert commit_of(tmp_path / "archive") == git(tmp_path, "rev-parse", "HEAD")
    shutil.copy(ROOT / "workflow/COMMIT", tmp_path / "archive/workflow/COMMIT")  # not filled in
    assert commit_of(tmp_path / "archive") == "not a git checkout"


def test_what_made_a_result(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    made = describe_origin()
    assert list(made) == ["commit", "code", "machine"] and CHECKOUT == ROOT
    assert made["commit"] == commit_of(ROOT) and made["code"] is None
    assert made == describe_origin()  # no time: the same job gives the same bytes
