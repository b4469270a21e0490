"""Pictures with matplotlib and tables with pandas; neither is needed for the rest."""

import numpy as np


def _axes(ax):
    if ax is None:
        from matplotlib import pyplot

        _, ax = pyplot.subplots()
    ax.set_aspect("equal")
    ax.set_xlabel("x in m")
    ax.set_ylabel("y in m")
    return ax


def grid(map, ax):
    """Draws a GridMap: occupied black, free white, unknown grey."""
    ax = _axes(ax)
    rows, columns = map.log_odds.shape
    left, bottom = map.origin
    extent = (left, left + columns * map.cell, bottom, bottom + rows * map.cell)
    free = 1 / (1 + np.exp(map.log_odds))
    ax.imshow(free, cmap="gray", vmin=0, vmax=1, extent=extent, interpolation="nearest")
    return ax


def run(result, ax):
    """Draws a LogResult: map, trajectory, and the accepted loops."""
    ax = _axes(ax) if result.map is None else grid(result.map, ax)
    ax.plot(*result.trajectory[:, :2].T, linewidth=1, label="trajectory")
    poses = result.keyframes
    loops = [(i, j) for i, j in result.graph.edges if j - i != 1]
    for number, (i, j) in enumerate(loops):
        label = "loops" if number == 0 else None
        ax.plot(*poses[[i, j], :2].T, color="tab:red", linewidth=0.5, label=label)
    ax.legend()
    return ax


def table(result):
    """The trajectory of a LogResult as a DataFrame, by the stamp in s."""
    import pandas

    index = pandas.Index(result.stamps, name="stamp")
    return pandas.DataFrame(result.trajectory, index=index, columns=["x", "y", "theta"])
