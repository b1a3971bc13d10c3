"""The boundary for files of strangers: what is refused, in one line, before memory is taken."""

import os
import stat
import tempfile
import zipfile

import pytest

from herringbone.core import FmuError, HerringboneError, ResourceError
from herringbone.core.reading.archives import open_archive
from herringbone.core.reading.numbers import LONGEST, number, whole
from herringbone.core.reading.structured import read_json, read_toml
from herringbone.core.reading.texts import lines_of, read_bytes, read_text
from herringbone.core.reading.xml import parse_xml


def refusal(action):
    with pytest.raises(HerringboneError) as caught:
        action()
    assert str(caught.value).isprintable()
    return str(caught.value)


@pytest.mark.parametrize("text", ["1", " -2.5e-3\t", "+.5", "6.", "0" * LONGEST, "1" + 200 * "0"])
def test_numbers(text):
    assert number(text) == float(text)


@pytest.mark.parametrize(
    "text",
    ["", " ", "1_000", "\uff11", "\u0663", "0x1F", "inf", "-nan", "1e999", "1e", ".", "1,5", "1 2",
     "1\n", "\xa01", "1d3", "0" * (LONGEST + 1)],
)  # fmt: skip
def test_what_is_no_number(text):
    with pytest.raises(ValueError, match="is not a finite number"):
        number(text)


def test_whole_numbers():
    assert whole(" -12") == -12
    for text in ("1.0", "1_0", "\u0663", "1" * 21, "", "0x1"):
        with pytest.raises(ValueError, match="is not a whole number"):
            whole(text)


def test_texts(tmp_path):
    file = tmp_path / "x"
    file.write_bytes(b"\xef\xbb\xbfa\r\nb\rc\x0bd\n")
    assert lines_of(read_text(file)) == ["a", "b", "c\x0bd"]
    file.write_bytes(b"a\0")
    assert "zero byte" in refusal(lambda: read_text(file))
    file.write_bytes(b"ab\xff")
    assert f"cannot read {file}: it is no UTF-8 text (byte 3)" in refusal(lambda: read_text(file))
    assert refusal(lambda: read_bytes(file, 2)).endswith("it is larger than 0 MiB")
    assert "No such file" in refusal(lambda: read_text(tmp_path / "y"))
    assert "cannot read" in refusal(lambda: read_text(tmp_path / "\0"))
    assert "it is no file" in refusal(lambda: read_text(tmp_path))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes")
def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "x")
    assert "it is no file" in refusal(lambda: read_toml(tmp_path / "x"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("x = inf", "x = inf is not a finite number"),
        ("[a]\nb = [1, nan]", "a.b.2 = nan is not a finite number"),
        ("x = 1e999", "x = inf is not a finite number"),
        ("x = 99999999999999999999", "x is a whole number of more than 64 bits"),
        ("x = " + "9" * 5000, "cannot read"),
        ("x = 0." + "1" * 5000, "too long a number"),
        ("x = " + "[" * 5000, "nested too deeply"),
        ("x = " + "[" * 60 + "]" * 60, "nested too deeply"),
        ("a." * 50_000 + "a = 1", "a key of more than 100 parts"),
        ("x" * (1 << 20) + "y", "larger than 1 MiB"),
    ],
)
def test_toml(tmp_path, text, said):
    (tmp_path / "x").write_text(text)
    assert said in refusal(lambda: read_toml(tmp_path / "x"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[1]", "it must be one JSON object"),
        ('{"a": Infinity}', "'Infinity' is not a finite number"),
        ('{"a": 1e999}', "'1e999' is not a finite number"),
        ('{"a": ' + "1" * 5000 + "}", "too long a number"),
        ('{"a": ' + "1" * 30 + "}", "a is a whole number of more than 64 bits"),
        ('{"a":' * 50_000, "nested too deeply"),
        ('{"a"', "is no valid JSON"),
    ],
)
def test_json(tmp_path, text, said):
    (tmp_path / "x").write_text(text)
    assert said in refusal(lambda: read_json(tmp_path / "x"))


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "latin-1"])
def test_xml_in_its_encoding(encoding):
    text = f'<?xml version="1.0" encoding="{encoding}"?><!--c--><a b="ü">ä</a>'
    root = parse_xml(text.encode(encoding), "x")
    assert (root.tag, root.attrib, root.text) == ("a", {"b": "ü"}, "ä")
    doctype = text.replace("<a", '<!DOCTYPE a [<!ENTITY e "ha">]><a').encode(encoding)
    said = refusal(lambda: parse_xml(doctype, "x", FmuError))
    assert said == "x declares a DOCTYPE or an entity; refused"


@pytest.mark.parametrize(
    "text", [b"", b"<a>", b"<a>&e;</a>", b"<a>\0</a>", b"\xff\xfe<", b"<a b=1/>"]
)
def test_what_is_no_xml(text):
    assert refusal(lambda: parse_xml(text, "x")).startswith("x is not well-formed")


def test_deep_xml():
    assert "nested more than 200 deep" in refusal(lambda: parse_xml(b"<a>" * 100_000, "x"))


def packed(file, entries, method=zipfile.ZIP_DEFLATED):
    with zipfile.ZipFile(file, "w", method) as archive:
        for name, content in entries:
            archive.writestr(name, content)
    return file


def opened(file):
    def open_and_extract():
        with open_archive(file, "an FMU", FmuError) as archive, tempfile.TemporaryDirectory() as to:
            archive.extract(to)

    return open_and_extract


def link():
    entry = zipfile.ZipInfo("link")
    entry.external_attr = (stat.S_IFLNK | 0o777) << 16
    return entry


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ([("../x", b"")], "entry '../x' would be written outside its folder"),
        ([("x", b""), (zipfile.ZipInfo(""), b"")], "an entry has no name"),
        ([("c:x", b"")], "would be written outside"),
        ([(link(), b"/etc/passwd")], "entry 'link' is a link"),
        ([("a/" * 300, b"")], "has a name of 600 characters"),
        ([("a", b""), ("a/b", b"")], "cannot be unpacked"),
        ([(f"{n}", b"") for n in range(65_536)], "65536 entries; at most 65535 are read"),
    ],
)
def test_archives(tmp_path, entries, said):
    file = packed(tmp_path / "x.fmu", entries)
    assert said in refusal(opened(file))


def test_an_archive_that_would_fill_the_disk(tmp_path):
    """300 MB of zeros are 300 kB."""
    file = packed(tmp_path / "x.fmu", [(f"{n}", bytes(100_000_000)) for n in range(3)])
    assert file.stat().st_size < 400_000
    assert "bytes would become 286 MiB; refused" in refusal(opened(file))


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_entries_that_stand_twice(tmp_path):
    file = packed(tmp_path / "x.fmu", [("a", b"1"), ("a", b"2")])
    assert "entry 'a' stands twice, with other content" in refusal(opened(file))


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_entries_that_stand_twice_alike(tmp_path):
    """As an FMU of the Modelica Association has them: `extra` was packed twice."""
    file = packed(tmp_path / "x.fmu", [("a", b"1"), ("b", b"2"), ("a", b"1")])
    opened(file)()


def test_unusual_compression(tmp_path):
    file = packed(tmp_path / "x.fmu", [("a", b"1")], zipfile.ZIP_LZMA)
    assert "packed by method 14, not deflated" in refusal(opened(file))


def test_damaged_archives(tmp_path):
    file = packed(tmp_path / "x.fmu", [("a", b"12345" * 100)], zipfile.ZIP_STORED)
    opened(file)()
    whole_file = file.read_bytes()
    file.write_bytes(whole_file.replace(b"12345", b"12346", 1))
    assert "cannot be unpacked: Bad CRC-32" in refusal(opened(file))
    file.write_bytes(whole_file[:-30])
    assert f"{file} is not an FMU" in refusal(opened(file))
    assert "there is no file" in refusal(opened(tmp_path / "y"))
    with open_archive(packed(file, [("a", b"12")]), "x", ResourceError) as archive:
        assert archive.read("a", 2) == b"12"
        assert "a is larger than 0 MiB" in refusal(lambda: archive.read("a", 1))
        assert "it contains no b" in refusal(lambda: archive.read("b", 1))
