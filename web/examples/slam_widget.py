"""The widgets in Jupyter and marimo: `pip install anywidget`, then in a cell

    from slam_widget import SlamWidget
    lap = SlamWidget(name="w16.2", value={"noise": 2})
    lap

Then `lap.value` is the state and `lap.outcome` the result. Setting `lap.value` changes the widget; an invalid value is
reported below it, and the others are set.
In marimo, wrap it, `lap = mo.ui.anywidget(SlamWidget(name="w16.2"))`, and cells react to its traits.
"""

import anywidget
import traitlets

# The address where the built site is served; `cargo xtask serve` prints it.
SITE = "http://localhost:8016"


class SlamWidget(anywidget.AnyWidget):
    """A widget of the chapter; docs/parameters.md lists names and parameters."""

    _esm = f"{SITE}/slam-anywidget.js"

    name = traitlets.Unicode("w16.1").tag(sync=True)
    value = traitlets.Dict().tag(sync=True)
    outcome = traitlets.Dict(allow_none=True, default_value=None).tag(sync=True)
