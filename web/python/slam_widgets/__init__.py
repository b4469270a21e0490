"""The widgets of the chapter on scan matching and pose-graph SLAM, for notebooks.

Each widget of the chapter is a class: `Basin`, `FullLap` and so on, see `WIDGETS`. Its parameters are arguments and
attributes, `value` holds all of them, and `outcome` what came out. Parameters whose names have a hyphen in links have
an underscore here: `gate_model`.
"""

import json
from importlib.resources import files
from urllib.parse import parse_qsl

import anywidget
import traitlets

__all__ = ["SlamWidget", "WIDGETS"]

_STATIC = files(__name__) / "static"
_SCHEMA = {widget["id"]: widget for widget in json.loads((_STATIC / "schema.json").read_text("utf-8"))}


class SlamWidget(anywidget.AnyWidget):
    """One widget of the chapter by its name, such as `SlamWidget(name="w16.2", value={"noise": 2})`."""

    _esm = (_STATIC / "slam-widgets.js").read_text("utf-8")

    name = traitlets.Unicode("w16.1").tag(sync=True)
    value = traitlets.Dict().tag(sync=True)
    outcome = traitlets.Dict(allow_none=True, default_value=None).tag(sync=True)

    @traitlets.validate("name")
    def _check_name(self, proposal):
        if proposal["value"] not in _SCHEMA:
            raise traitlets.TraitError(f"no widget is called {proposal['value']!r}; there are {', '.join(_SCHEMA)}")
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
        """The widget in the state of a link, or of what “Copy link” gives: `?w=16.1&heading=60`."""
        stated = dict(parse_qsl(link.partition("?")[2], keep_blank_values=True))
        widget = "w" + stated.pop("w", cls._id[1:])
        if widget != cls._id:
            raise ValueError(f"the link is of {widget}, and {cls.__name__} is {cls._id}")
        names = set(cls._ids.values())
        return cls(value={name: _plain(text) for name, text in stated.items() if name in names})

    @classmethod
    def _parameter(cls, attribute):
        if attribute not in cls._ids:
            raise TypeError(f"{cls.__name__} has no parameter {attribute!r}; it has {', '.join(cls._ids)}")
        return cls._ids[attribute]

    def _get(self, parameter):
        return self.value.get(parameter, _default(self._id, parameter))

    def _set(self, parameter, given):
        self.value = {**self.value, parameter: given}


def _plain(text):
    """A number where the text is one."""
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
    """The class of a widget: its title in one word, its parameters as properties."""
    title = "".join(word[:1].upper() + word[1:] for word in widget["title"].replace("-", " ").split())
    name = _SHORT.get(widget["id"], title.removeprefix("The"))
    ids = {spec["id"].replace("-", "_"): spec["id"] for spec in widget["params"]}
    lines = [f"{attribute}: {_range(_spec(widget['id'], id))}. {_spec(widget['id'], id)['help']}" for attribute, id in ids.items()]
    body = {
        "__doc__": "\n\n".join([f"{widget['title']} ({widget['id']}). {widget['misconception']}", *lines]),
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
    return type(name, (_Widget,), body)


_SHORT = {"w16.1": "Basin"}

#: Every widget's class by its name in the chapter: `WIDGETS["w16.1"]` is `Basin`.
WIDGETS = {id: _class(widget) for id, widget in _SCHEMA.items()}
globals().update({made.__name__: made for made in WIDGETS.values()})
__all__ += [made.__name__ for made in WIDGETS.values()]
