"""The wheel, where nothing is installed yet."""

import os
import subprocess
import venv

from conftest import ROOT, skip

#: Most processor time that an installation may take, s; time on the clock would depend on what else the machine does.
MOST_S = 30


def wheel():
    """The newest wheel: of `cargo xtask package`, or of the tests."""
    folders = [ROOT / "target/packages", ROOT / "target/python/wheels"]
    return max((path for folder in folders for path in folder.glob("rustslam2d-*.whl")), key=os.path.getmtime)


def test_the_wheel_installs_in_an_empty_environment_in_less_than_half_a_minute(tmp_path):
    venv.create(tmp_path, with_pip=True)
    python = tmp_path / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    before = os.times()
    install = [python, "-m", "pip", "--disable-pip-version-check", "install", "--quiet", wheel()]
    installed = subprocess.run(install, capture_output=True, text=True)
    after = os.times()
    if "WARNING: Retrying (" in installed.stderr:
        skip("the wheel in an empty environment", "no package registry can be reached, which has numpy")
    assert installed.returncode == 0, installed.stderr
    took_s = after.children_user - before.children_user + after.children_system - before.children_system
    assert took_s < MOST_S, f"{took_s:.0f} s"
    drive = "import rustslam2d as rs; print(rs.simulate(icp=lambda source, target, init, **_: init).slam)"
    driven = subprocess.run([python, "-c", drive], capture_output=True, text=True, cwd=tmp_path)
    assert driven.stdout.startswith("Slam(130 scans"), driven.stderr
