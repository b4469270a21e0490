"""The tests of an exercise in one process, the student's code in another.

The tests import a module whose functions send each call to the process of the student, and get a value back: arrays,
numbers, texts, lists, tuples and the types of given.py. A value is read without running anything.
"""

import importlib
import io
import json
import pickle
import subprocess
import sys
import threading
import warnings

import numpy as np

#: What `python -c` runs for the tests, and for the student.
TESTS = "from rustslam2d._apart import tests; tests()"
STUDENT = "from rustslam2d._apart import answer_calls; answer_calls()"

#: Largest message; more is no answer.
MOST_BYTES = 1 << 30

_student = None


def function(module, name):
    """The student's function of that name, which runs in the other process."""
    if name.startswith("__"):
        raise AttributeError(name)
    return lambda *given, **named: _student.call(module, name, given, named)


class Student:
    """The process of the student's code. It starts with the first call, so the tests are collected without it."""

    def __init__(self, folder, limit_s):
        self._folder, self._limit_s = folder, limit_s
        self._process, self._ended = None, None

    def call(self, module, name, given, named):
        """Calls a function there; raises what it raised, or RuntimeError if it gives no answer."""
        if self._ended is None and self._process is None:
            self._start()
        if self._ended is not None:
            raise RuntimeError(self._ended)
        # pytest.mark.filterwarnings("error") counts there as well.
        strict = bool(warnings.filters) and warnings.filters[0][0] == "error"
        try:
            write(self._process.stdin, pickle.dumps((module, name, given, named, strict)))
            kind, value, changed = read(self._process.stdout)
        except (OSError, EOFError, ValueError, pickle.UnpicklingError):
            self._ended = self._ended or f"the process of {module}.py ended before it answered"
            raise RuntimeError(self._ended) from None
        for at, array in changed:
            given[at][...] = decoded(array)
        if kind == "value":
            return decoded(value)
        raised, text = value
        error = NotImplementedError if raised == "NotImplementedError" else RuntimeError
        raise error(text if error is NotImplementedError else f"{module}.py ended with {raised}: {text}")

    def _start(self):
        self._process = subprocess.Popen(
            [sys.executable, "-B", "-c", STUDENT],
            cwd=self._folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )
        self._timer = threading.Timer(self._limit_s, self._late)
        self._timer.daemon = True
        self._timer.start()

    def _late(self):
        self._ended = f"it was ended after {self._limit_s} s; is there an infinite loop?"
        self._process.kill()

    def end(self):
        """Ends the process."""
        if self._process is not None:
            self._timer.cancel()
            self._process.kill()


class Report:
    """A plugin of pytest: each test's result, and the first failure."""

    def __init__(self):
        self.results, self.message = {}, None

    def pytest_collection_modifyitems(self, items):
        self.results = {item.name: False for item in items}
        self._passed = {item.name: [] for item in items}

    def pytest_runtest_logreport(self, report):
        name = report.nodeid.split("::", 1)[-1]
        self._passed[name].append(report.passed)
        # Setup, call and teardown.
        self.results[name] = self._passed[name] == [True, True, True]
        if not report.passed and self.message is None:
            crash = getattr(report.longrepr, "reprcrash", None)
            self.message = f"{name}\n{crash.message if crash else report.longreprtext}"

    def pytest_collectreport(self, report):
        if report.failed and self.message is None:
            self.message = report.longreprtext


def tests():
    """Runs the tests that the order names, and prints the key with the report."""
    global _student
    import pytest

    order = json.loads(sys.stdin.read())
    _student, report = Student(order["student"], order["limit_s"]), Report()
    pytest.main(["-q", "-p", "no:cacheprovider", "--tb=line", order["test"]], plugins=[report])
    _student.end()
    print(f"\n{order['key']}{json.dumps({'results': report.results, 'message': report.message})}", flush=True)


def answer_calls():
    """The student's side: reads calls from the standard input until it ends."""
    import os

    answers, calls = os.fdopen(os.dup(1), "wb"), os.fdopen(os.dup(0), "rb")
    # What the code prints is no answer, and it has no input.
    os.dup2(2, 1)
    os.close(0)
    while True:
        try:
            module, name, given, named, strict = pickle.loads(read_bytes(calls))
        except EOFError:
            return
        arrays = [(at, one, one.copy()) for at, one in enumerate(given) if isinstance(one, np.ndarray)]
        try:
            with warnings.catch_warnings():
                if strict:
                    warnings.simplefilter("error")
                answer = "value", encoded(getattr(importlib.import_module(module), name)(*given, **named))
        except Exception as error:
            answer = "error", (type(error).__name__, str(error)[:2000])
        changed = [(at, encoded(now)) for at, now, before in arrays if not np.array_equal(now, before, equal_nan=True)]
        write(answers, pickle.dumps((*answer, changed)))


def encoded(value):
    """A value as bytes, numbers and texts, with a tag."""
    if isinstance(value, (np.ndarray, np.generic)):
        if value.dtype.kind not in "fiub":
            raise TypeError(f"an array of {value.dtype} was returned, expected numbers")
        return "array", value.dtype.str, value.shape, value.tobytes()
    if value is None or isinstance(value, (bool, int, float, str)):
        return "plain", value
    if isinstance(value, (tuple, list)):
        is_named = hasattr(value, "_fields")
        kind = type(value).__name__ if is_named else "tuple" if isinstance(value, tuple) else "list"
        return kind, [encoded(one) for one in value]
    raise TypeError(f"a {type(value).__name__} was returned, expected numbers, arrays, tuples or lists")


def decoded(value):
    """The value of :func:`encoded`."""
    kind, *rest = value
    if kind == "plain":
        return rest[0]
    if kind == "array":
        dtype, shape, content = rest
        found = np.frombuffer(content, np.dtype(dtype)).reshape(shape).copy()
        return found if shape else found[()]
    items = [decoded(one) for one in rest[0]]
    if kind in ("list", "tuple"):
        return items if kind == "list" else tuple(items)
    result = getattr(importlib.import_module("given"), kind, None)
    if not hasattr(result, "_fields"):
        raise TypeError(f"a {kind} was returned, which is not a type of given.py")
    return result(*items)


class Plain(pickle.Unpickler):
    """Reads containers, numbers, texts and bytes; anything else would run code."""

    def find_class(self, module, name):
        raise pickle.UnpicklingError(f"{module}.{name} is not a plain value")


def write(stream, content):
    """A length, and that many bytes."""
    stream.write(len(content).to_bytes(8, "little") + content)
    stream.flush()


def read_bytes(stream):
    """What :func:`write` wrote; EOFError at the end."""
    head = stream.read(8)
    size = int.from_bytes(head, "little")
    if len(head) < 8 or size > MOST_BYTES:
        raise EOFError
    content = stream.read(size)
    if len(content) < size:
        raise EOFError
    return content


def read(stream):
    """A plain value."""
    return Plain(io.BytesIO(read_bytes(stream))).load()
