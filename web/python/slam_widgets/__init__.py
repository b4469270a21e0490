"""The widgets of the chapter on scan matching and pose-graph SLAM, for notebooks.

Each widget of the chapter is a class, such as `Basin` or `FullLap`; `WIDGETS` lists them. Parameters are arguments and
attributes: `value` has all of them, and `outcome` the result. Names with a hyphen in links have an underscore here:
`gate_model`. `Robot("log.mcap")` maps a recorded log.
"""

import json
import re
from importlib.resources import files
from pathlib import Path
from urllib.parse import parse_qsl

import anywidget
import traitlets

__all__ = ["SlamWidget", "WIDGETS", "Robot"]

_STATIC = files(__name__) / "static"
_SCHEMA = {widget["id"]: widget for widget in json.loads((_STATIC / "schema.json").read_text("utf-8"))}


class SlamWidget(anywidget.AnyWidget):
    """A widget of the chapter by its name, such as `SlamWidget(name="w16.2", value={"noise": 2})`."""

    _esm = (_STATIC / "slam-widgets.js").read_text("utf-8")

    name = traitlets.Unicode("w16.1").tag(sync=True)
    value = traitlets.Dict().tag(sync=True)
    outcome = traitlets.Dict(allow_none=True, default_value=None).tag(sync=True)

    @traitlets.validate("name")
    def _check_name(self, proposal):
        if proposal["value"] not in _SCHEMA:
            raise traitlets.TraitError(f"there is no widget {proposal['value']!r}; there are {', '.join(_SCHEMA)}")
        return proposal["value"]


class _Widget(SlamWidget):
    """A widget whose parameters are attributes."""

    _id = ""
    _ids = {}

    def __init__(self, **parameters):
        traits = {key: parameters.pop(key) for key in list(parameters) if key in ("layout", "value")}
        value = {**traits.pop("value", {}), **{self._parameter(key): given for key, given in parameters.items()}}
        super().__init__(name=self._id, value=value, **traits)

    @classmethod
    def from_link(cls, link):
        """Returns the widget in the state of a link from “Copy link”, or of its query: `?w=16.1&heading=60`."""
        query = dict(parse_qsl(link.partition("?")[2], keep_blank_values=True))
        widget = "w" + query.pop("w", cls._id[1:])
        if widget != cls._id:
            raise ValueError(f"the link is for {widget}, and {cls.__name__} is {cls._id}")
        names = set(cls._ids.values())
        return cls(value={name: _parse(text) for name, text in query.items() if name in names})

    @classmethod
    def _parameter(cls, attribute):
        if attribute not in cls._ids:
            raise TypeError(f"{cls.__name__} has no parameter {attribute!r}; it has {', '.join(cls._ids)}")
        return cls._ids[attribute]

    def _get(self, parameter):
        return self.value.get(parameter, _default(self._id, parameter))

    def _set(self, parameter, given):
        self.value = {**self.value, parameter: given}


def _parse(text):
    """Returns a number if the text is one, else the text."""
    try:
        return float(text)
    except ValueError:
        return text


def _spec(widget, parameter):
    return next(spec for spec in _SCHEMA[widget]["params"] if spec["id"] == parameter)


def _default(widget, parameter):
    spec = _spec(widget, parameter)
    if spec["kind"] == "choice":
        return spec["options"][int(spec["default"])]["id"]
    if spec["kind"] == "text":
        return ""
    return bool(spec["default"]) if spec["kind"] == "switch" else spec["default"]


def _range(spec):
    if spec["kind"] == "choice":
        return " or ".join(repr(option["id"]) for option in spec["options"])
    if spec["kind"] == "switch":
        return "True or False"
    if spec["kind"] == "text":
        return f"at most {spec['max']} letters, digits, - and _"
    return f"{spec['min']} to {spec['max']} {spec['unit']}".rstrip()


def _class(widget):
    """Creates the class of a widget, with its name and its parameters as properties."""
    title = "".join(word[:1].upper() + word[1:] for word in re.findall(r"\w+", widget["name"]))
    name = _SHORT.get(widget["id"], title.removeprefix("The"))
    ids = {spec["id"].replace("-", "_"): spec["id"] for spec in widget["params"]}
    lines = [f"{attribute}: {_range(_spec(widget['id'], id))}. {_spec(widget['id'], id)['help']}" for attribute, id in ids.items()]
    body = {
        "__doc__": "\n\n".join([f"{widget['name']} ({widget['id']}). {widget['title']}", *lines]),
        "__module__": __name__,
        "_id": widget["id"],
        "_ids": ids,
    }
    for attribute, id in ids.items():
        body[attribute] = property(
            lambda self, id=id: self._get(id),
            lambda self, given, id=id: self._set(id, given),
            doc=_spec(widget["id"], id)["help"],
        )
    return type(name, (_RobotWidget if widget["id"] == "w16.10" else _Widget,), body)


_SHORT = {"w16.1": "Basin", "w16.10": "Robot"}

#: Size of a message with a piece of a file, bytes.
_PIECE_BYTES = 1 << 20


class _RobotWidget(_Widget):
    """w16.10, which exchanges files between kernel and page."""

    #: Every plot and table as CSV, by its name: loops, keyframes, where.
    tables = traitlets.Dict().tag(sync=True)
    #: Why the last rejected file was rejected.
    rejected = traitlets.Unicode("")

    def __init__(self, log=None, *, reference=None, where=None, **parameters):
        # Files by their purpose, in order: each page that shows the widget gets them.
        self._files = {}
        # Target paths by the names of the requested files.
        self._requested = {}
        self._saved = []
        super().__init__(**parameters)
        self.on_msg(self._receive)
        for path, add in ((log, self.load), (reference, self.grade), (where, self.locate)):
            if path is not None:
                add(path)

    def load(self, path):
        """Maps a log, or opens a session or a pose graph; it replaces the present one."""
        self._files.clear()
        self._add(path, "map")

    def grade(self, path):
        """Grades the map against relations (`.relations`) or ground truth (`.tum`)."""
        self._add(path, "grade")

    def locate(self, path):
        """Localizes the robot of another log on the map."""
        self._add(path, "where")

    def save(self, name, path=None):
        """Requests a file from the page, such as `session.slam2d` or `map.png`, and writes it to `path` on arrival.

        `saved` lists the files that arrived, and `rejected` has the reason why one did not.
        """
        self._requested.setdefault(name, []).append(Path(path or name))
        self.send({"type": "file", "name": name})

    @property
    def saved(self):
        """The files that were written."""
        return list(self._saved)

    def _add(self, path, use):
        path = Path(path)
        if not path.is_file():
            raise FileNotFoundError(f"{path} is not a readable file; use a log, a session or a reference")
        self._files[use] = path
        self._send_file(path, use)

    def _send_file(self, path, use):
        size = path.stat().st_size
        with path.open("rb") as source:
            at = 0
            while at == 0 or at < size:
                piece = source.read(_PIECE_BYTES)
                last = at + len(piece) >= size or not piece
                message = {"type": "piece", "name": path.name, "use": use, "first": at == 0, "last": last}
                self.send(message, [piece])
                at += len(piece)
                if last:
                    break

    def _receive(self, _, message, buffers):
        kind = message.get("type")
        if kind == "ready":
            # A page that has just opened has no files.
            for use, path in self._files.items():
                self._send_file(path, use)
        elif kind == "file":
            paths = self._requested.get(message["name"], [])
            if paths:
                path = paths.pop(0)
                path.write_bytes(bytes(buffers[0]))
                self._saved.append(path)
        elif kind == "rejected":
            paths = self._requested.get(message["name"], [])
            if paths:
                paths.pop(0)
            self.rejected = message["why"]

#: Every widget's class by its name in the chapter: `WIDGETS["w16.1"]` is `Basin`.
WIDGETS = {id: _class(widget) for id, widget in _SCHEMA.items()}
globals().update({made.__name__: made for made in WIDGETS.values()})
__all__ += [made.__name__ for made in WIDGETS.values() if made.__name__ not in __all__]
