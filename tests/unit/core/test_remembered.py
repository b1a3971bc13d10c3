"""What is found once in a process, by content."""

import os
from threading import Thread

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from herringbone.components.resources.flat_csv import read_flat_csv
from herringbone.core import ResourceError
from herringbone.core.caching import remembered
from herringbone.core.caching.remembered import Remembered, content_key
from herringbone.core.process.one_thread import one_blas_thread

TEXT = "# units: load N\nload\n{}\n"


def read(file):
    return read_flat_csv(file, (), {"load": ("N",)})[0]["load"].tolist()


def test_the_last_ones_are_kept():
    calls, known = [], Remembered(2)
    for key in (1, 2, 1, 3, 1, 2):
        known(key, lambda key=key: calls.append(key))
    assert calls == [1, 2, 3, 2]


def test_what_is_raised_is_not_kept():
    known = Remembered(2)
    with pytest.raises(ZeroDivisionError):
        known(1, lambda: 1 // 0)
    assert known(1, lambda: 5) == 5


def test_a_file_that_is_written_again_at_once_is_read_again(tmp_path):
    file = tmp_path / "a.csv"
    for value in range(5):  # same size, and often the same time
        file.write_text(TEXT.format(value))
        assert read(file) == [value]


def test_an_old_file_is_read_once(tmp_path, monkeypatch):
    monkeypatch.setattr(remembered, "_SETTLED", 0)
    file = tmp_path / "a.csv"
    file.write_text(TEXT.format(1))
    key = content_key(file)
    monkeypatch.setattr(remembered, "content_of", lambda file: "other")
    assert content_key(file) == key
    os.utime(file, (1.0, 1.0))
    assert content_key(file) == "other"


def test_who_changes_a_table_changes_his_own(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text(TEXT.format(1))
    read_flat_csv(file, (), {"load": ("N",)})[0]["load"][0] = 7.0
    assert read(file) == [1.0]


def test_what_is_no_file_has_no_content(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)  # reading it would wait for ever
    assert content_key(pipe) == content_key(tmp_path) == content_key(tmp_path / "absent") == ""
    with pytest.raises(ResourceError):
        read(pipe)


def threads() -> set[int]:
    return {
        library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"
    }


def test_the_last_context_brings_threads_back():
    """Contexts of several threads overlap, and the number is of the whole process."""
    with threadpool_limits(limits=2, user_api="blas"):
        before, found = threads(), []
        first = one_blas_thread()
        first.__enter__()
        second = one_blas_thread()
        worker = Thread(target=lambda: (second.__enter__(), found.append(threads())))
        worker.start()
        worker.join()
        first.__exit__(None, None, None)
        assert found == [{1}]
        assert threads() == {1}
        second.__exit__(None, None, None)
        assert threads() == before


def test_a_thread_has_its_context_whoever_had_one_before():
    with threadpool_limits(limits=2, user_api="blas"):
        with one_blas_thread():
            pass
        found = []

        def work():
            with one_blas_thread():
                found.append(threads())

        for _ in range(2):
            worker = Thread(target=work)
            worker.start()
            worker.join()
        assert found == [{1}, {1}]
        assert threads() == {2}
