"""The course's notebooks run from top to bottom: their assertions hold figures against closed forms."""

import pathlib
import warnings

import pytest

NOTEBOOKS = sorted((pathlib.Path(__file__).resolve().parents[3] / "bindings/python/notebooks").glob("*.ipynb"))
matplotlib = pytest.importorskip("matplotlib", reason="install python3-matplotlib")
nbformat = pytest.importorskip("nbformat", reason="install python3-nbformat")
nbclient = pytest.importorskip("nbclient", reason="install python3-nbclient")
pytest.importorskip("ipykernel", reason="install python3-ipykernel")


def test_there_is_one_a_chapter():
    assert [path.name[:2] for path in NOTEBOOKS] == ["1-", "2-", "3-", "4-", "5-"]


def executed(notebook):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of the client's own libraries
        nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    return notebook


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert not any(cell.outputs or cell.execution_count for cell in code), "clear the outputs"
    executed(notebook)
    kinds = {kind for cell in code for output in cell.outputs for kind in output.get("data", {})}
    assert "image/png" in kinds, "no figure"
    if path.stem.startswith("1-"):
        page = code[-1].outputs[-1]["data"]["text/html"]
        assert page.count("data:image/png;base64") == 91, "3 s of 30 frames a second, and the first"


def test_a_claim_that_does_not_hold_fails():
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("assert 1 + 1 == 3")])
    with pytest.raises(nbclient.exceptions.CellExecutionError):
        executed(notebook)
