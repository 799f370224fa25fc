"""Errors are exceptions that say where they occurred."""

import pickle

import pytest

import lobe_bsdf


def test_a_missing_file_is_an_error_of_the_system(tmp_path):
    with pytest.raises(FileNotFoundError) as caught:
        lobe_bsdf.open(tmp_path / "missing.ddr")
    assert caught.value.filename == str(tmp_path / "missing.ddr")


def test_a_damaged_file_is_named_with_its_line(fixtures, tmp_path):
    lines = (fixtures / "conductor-7x8x13.ddr").read_text().splitlines()
    numbers = [index for index, line in enumerate(lines) if line[:1].isdigit() or line[:1] == " "]
    lines[numbers[-1]] = "0.1 oops 0.3"
    file = tmp_path / "damaged.ddr"
    file.write_text("\n".join(lines))
    with pytest.raises(lobe_bsdf.FormatError) as caught:
        lobe_bsdf.open(file)
    error = caught.value
    assert isinstance(error, ValueError)
    assert error.file == str(file) and error.line == numbers[-1] + 1 and error.byte is None
    assert str(error).startswith(f"{file}:{error.line}: found ") and error.found and error.expected
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.file, again.line) == (str(error), error.file, error.line)


def test_files_that_are_not_materials_are_reported(tmp_path):
    with pytest.raises(lobe_bsdf.FormatError, match="memory"):
        lobe_bsdf.from_bytes(b"")
    with pytest.raises(lobe_bsdf.FormatError, match="page.xml.*web page"):
        lobe_bsdf.from_bytes(b"<!DOCTYPE html><html></html>", "page.xml")
    with pytest.raises(lobe_bsdf.FormatError):
        lobe_bsdf.from_bytes(bytes(range(256)) * 40)


def test_a_folder_is_an_error(tmp_path):
    with pytest.raises(ValueError):
        lobe_bsdf.open(tmp_path)


def test_options_of_reading_are_checked(tmp_path):
    file = tmp_path / "own.csv"
    file.write_text("theta_i,theta_o,value\n0,0,0.3\n0,30,0.3\n0,60,0.3\n")
    with pytest.raises(ValueError, match="unit: found"):
        lobe_bsdf.open(file, unit="gon")
    with pytest.raises(ValueError, match="columns: found"):
        lobe_bsdf.open(file, columns="theta_i")


@pytest.mark.parametrize("class_", [lobe_bsdf.Material, lobe_bsdf.Sampler, lobe_bsdf.Picture])
def test_classes_are_made_by_functions(class_):
    with pytest.raises(TypeError):
        class_()


def test_materials_do_not_change(conductor):
    with pytest.raises(AttributeError):
        conductor.channels = ("X",)
