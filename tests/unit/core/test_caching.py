"""The cache: what is damaged, foreign or left behind."""

import errno
import json
import os
import sys
import time
from threading import Event, Thread

import pytest

from herringbone.core import ResourceError
from herringbone.core.caching import generated
from herringbone.core.caching.files import (
    all_stored,
    alone_in,
    is_stored,
    keep,
    kept,
    store,
    store_all,
    write_file,
)
from herringbone.core.caching.generated import load_generated
from herringbone.core.places.paths import CACHE_VARIABLE, cache_folder

posix = pytest.mark.skipif(os.name == "nt", reason="owners and modes of POSIX")
ROOT = hasattr(os, "getuid") and os.getuid() == 0


@pytest.fixture(autouse=True)
def cache(monkeypatch, tmp_path):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.mark.parametrize("content", [b"", b"wo", b"worm"])
@pytest.mark.parametrize("suffix", ["", ".sha256"])
def test_damaged_files_are_not_stored(tmp_path, caplog, content, suffix):
    store(tmp_path / "x", b"word")
    assert is_stored(tmp_path / "x")
    (tmp_path / f"x{suffix}").write_bytes(content)
    assert not is_stored(tmp_path / "x")
    assert f"{tmp_path / 'x'} is damaged; it is made anew" in caplog.text


def test_files_that_belong_together_are_there_all_or_none(tmp_path):
    """A process that dies while it stores them leaves some, and no list of them."""
    store(tmp_path / "x.o", b"code")
    assert all_stored(tmp_path) == []
    store_all(tmp_path, {"y.o": b"y", "x.o": b"x"})
    assert all_stored(tmp_path) == [tmp_path / "x.o", tmp_path / "y.o"]
    (tmp_path / "x.o").unlink()
    assert all_stored(tmp_path) == []


@pytest.mark.parametrize("content", ["", "{", "null", '{"a": 1}', "0\n{}", "\0"])
def test_damaged_memos_are_as_none(tmp_path, content):
    keep(tmp_path / "x", {"a": [1.5]})
    assert kept(tmp_path / "x") == {"a": [1.5]}
    (tmp_path / "x").write_text(content)
    assert kept(tmp_path / "x") is None


def test_a_changed_digit_is_damage(tmp_path):
    keep(tmp_path / "x", {"a": 15})
    (tmp_path / "x").write_text((tmp_path / "x").read_text().replace("15}", "16}"))
    assert kept(tmp_path / "x") is None
    assert json.loads((tmp_path / "x").read_text().partition("\n")[2]) == {"a": 16}


def test_damaged_byte_code_is_made_anew(cache):
    """Python itself would end with 'marshal data too short'."""
    source = "def answer():\n    return 42\n"
    assert load_generated("test", source).answer() == 42
    (code,) = (cache / "generated").glob("*.code")
    whole = code.read_bytes()
    for damaged in (whole[: len(whole) // 2], b"", whole.replace(b"answer", b"ANSWER")):
        code.write_bytes(damaged)
        for name in [n for n in sys.modules if n.startswith("herringbone_test_")]:
            del sys.modules[name]
        assert load_generated("test", source).answer() == 42
        assert code.read_bytes() == whole


def test_generated_modules_of_a_moved_cache_lie_where_it_is(cache, monkeypatch):
    """Else nothing compiles: their machine code is known by the file that they lie in."""
    source = "def answer():\n    return 43\n"
    name = load_generated("test", source).__name__
    moved = cache.rename(cache.with_name("moved"))
    monkeypatch.setenv(CACHE_VARIABLE, str(moved))
    del sys.modules[name]
    found = load_generated("test", source).answer
    assert found() == 43
    assert found.__code__.co_filename == str(moved / "generated" / f"{name}.py")


def test_threads_do_not_see_half_of_a_module(monkeypatch):
    begun, asked, found = Event(), Event(), []
    monkeypatch.setattr(generated, "waited", lambda: begun.set() or asked.wait(30), raising=False)
    source = f"from {generated.__name__} import waited\nwaited()\nvalue = 7\n"
    name = f"herringbone_test_{generated.digest_of(source)}"
    threads = [Thread(target=lambda: found.append(load_generated("test", source)))]
    threads[0].start()
    begun.wait(30)
    threads.append(Thread(target=lambda: found.append(load_generated("test", source).value)))
    threads[1].start()
    threads[1].join(0.2)  # without a lock, it has ended by now
    asked.set()
    for thread in threads:
        thread.join()
    assert found == [sys.modules[name], 7]


def test_a_module_that_did_not_load_is_loaded_again(monkeypatch):
    monkeypatch.setattr(generated, "interrupt", iter([KeyboardInterrupt, None]), raising=False)
    source = (
        f"from {generated.__name__} import interrupt\n"
        "if error := next(interrupt):\n    raise error\nvalue = 8\n"
    )
    with pytest.raises(KeyboardInterrupt):
        load_generated("test", source)
    assert load_generated("test", source).value == 8


def test_byte_code_for_which_there_is_no_room_is_not_needed(monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(generated, "store", full)
    assert load_generated("test", "value = 9\n").value == 9


@posix
def test_a_new_cache_is_of_its_user_alone(cache):
    assert cache_folder("x").is_dir()
    assert cache.stat().st_mode & 0o777 == 0o700


@posix
def test_a_new_cache_is_of_its_user_alone_whatever_the_umask(cache):
    """Else it would be refused as soon as it is there, where a group may write by default."""
    before = os.umask(0)
    try:
        write_file(cache / "a" / "b" / "x", b"")
        cache_folder("c")
        with alone_in(cache / "d" / "e"):
            pass
    finally:
        os.umask(before)
    made = [cache, *(place for place in cache.rglob("*") if place.is_dir())]
    assert len(made) == 6
    assert {place.stat().st_mode & 0o777 for place in made} == {0o700}


@posix
@pytest.mark.parametrize("inner", [False, True])
def test_a_cache_that_others_can_write_is_refused(cache, inner):
    folder = cache_folder("x") if inner else cache
    folder.mkdir(exist_ok=True)
    folder.chmod(0o777)
    with pytest.raises(ResourceError, match=f"{folder} holds code that is run, .* 'chmod go-w' it"):
        cache_folder("x")
    folder.chmod(0o755)
    assert cache_folder("x").is_dir()


@posix
def test_a_file_that_others_can_write_is_made_anew(tmp_path, caplog):
    store(tmp_path / "x", b"word")
    keep(tmp_path / "y", 3)
    for name in "xy":
        (tmp_path / name).chmod(0o666)
    assert not is_stored(tmp_path / "x")
    assert kept(tmp_path / "y") is None
    for name in "xy":
        line = f"{tmp_path / name} is of another user, or others can write it; it is made anew"
        assert line in caplog.text


@posix
@pytest.mark.skipif(not ROOT, reason="only the administrator can give files away")
def test_what_is_of_another_user(tmp_path, cache):
    store(tmp_path / "x", b"word")
    os.chown(tmp_path / "x", 12345, -1)
    assert not is_stored(tmp_path / "x")
    store(tmp_path / "x", b"word")
    assert is_stored(tmp_path / "x")
    os.chown(cache_folder("x"), 12345, -1)
    with pytest.raises(ResourceError, match="is of another user"):
        cache_folder("x")


def test_what_was_not_written_to_its_end_is_swept(tmp_path):
    old, young = tmp_path / "old.part", tmp_path / "young.part"
    for file in (old, young):
        file.touch()
    os.utime(old, (time.time() - 7200,) * 2)
    write_file(tmp_path / "x", b"word")
    assert sorted(file.name for file in tmp_path.iterdir() if file.is_file()) == ["x", "young.part"]
