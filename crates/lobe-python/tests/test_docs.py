"""Runs the code shown in the documents."""

import importlib.util
import os
import re

import pytest
from conftest import REPOSITORY

DOCUMENTS = [REPOSITORY / "docs/python.md", REPOSITORY / "README.md"]


def blocks():
    for document in DOCUMENTS:
        for number, block in enumerate(re.findall(r"^```python\n(.*?)^```", document.read_text(), re.M | re.S)):
            yield pytest.param(block, id=f"{document.name}-{number}")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("block", list(blocks()))
def test_blocks_run(block, tmp_path, monkeypatch):
    for module in re.findall(r"^import (\w+)", block, re.M):
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"{module} is not installed")
    for folder in ("fixtures", "docs"):
        os.symlink(REPOSITORY / folder, tmp_path / folder)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    exec(compile(block, "block", "exec"), {"__name__": "__main__"})
