# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""scripts/setup.sh and scripts/build_gtsam.sh where something is lacking: one plain sentence, status 1, nothing half-done."""
import pathlib
import shutil
import subprocess

import pytest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
ARCHIVE = "http://deb.example/debian/"
# apt-get without a network: an update only warns unless told otherwise, and no package is found.
OFFLINE = f"""case "$*" in
  *indextargets*) echo {ARCHIVE} ;;
  *Error-Mode=any*) echo "W: Failed to fetch {ARCHIVE}dists/trixie/InRelease  Could not resolve 'deb.example'" >&2; exit 100 ;;
  *" source "* | *" install "* | install*) echo "E: Unable to locate package" >&2; exit 100 ;;
esac"""

pytestmark = pytest.mark.skipif(pathlib.Path("/opt/ros/noetic").is_dir(), reason="on ROS Noetic setup.sh installs nothing")


class Machine:
    """Stubs in front of PATH, each of which notes how it was called: root, disk and apt-get, but nothing installed and no network."""

    def __init__(self, folder):
        self.bin, self.temporary, self.prefix = folder / "bin", folder / "tmp", folder / "gtsam"
        self.calls = folder / "calls"
        self.bin.mkdir()
        self.temporary.mkdir()
        self.has("id", "echo 0")
        self.has("df", "echo Avail; echo 99999")
        self.has("dpkg-query", "exit 1")
        self.has("cmake", "exit 1")
        self.has("apt-get", OFFLINE)

    def has(self, command, script):
        """Gives the machine another command."""
        path = self.bin / command
        path.write_text(f"#!/bin/bash\necho {command} \"$@\" >>'{self.calls}'\n{script}\n")
        path.chmod(0o755)

    def run(self, script, path=None):
        """What a script says on this machine."""
        environment = {"PATH": path or f"{self.bin}:/usr/bin:/bin", "TMPDIR": str(self.temporary), "GTSAM_PREFIX": str(self.prefix), "LC_ALL": "C"}
        return subprocess.run(["/bin/bash", SCRIPTS / script], text=True, capture_output=True, env=environment, check=False, timeout=60)

    def called(self, command):
        """The calls of a command."""
        lines = self.calls.read_text().splitlines() if self.calls.exists() else []
        return [line for line in lines if line.split()[0] == command]


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def refused(done, name, *parts):
    """One plain sentence on standard error and status 1."""
    assert done.returncode == 1, done.stderr
    assert len(done.stderr.splitlines()) == 1 and done.stderr.startswith(f"{name}: "), done.stderr
    for part in parts:
        assert part in done.stderr


def test_setup_without_root(machine):
    machine.has("id", "echo 1000")
    refused(machine.run("setup.sh"), "setup", "root", "libgtest-dev")
    assert not machine.called("apt-get") and not machine.called("cmake")


def test_setup_without_disk(machine):
    machine.has("df", "echo Avail; echo 17")
    refused(machine.run("setup.sh"), "setup", "6 GB", "17 MB")
    assert not machine.called("apt-get") and not machine.called("cmake")


def test_setup_without_network(machine):
    done = machine.run("setup.sh")
    refused(done, "setup", "network", "Unable to locate package")
    assert not machine.called("cmake"), "GTSAM waits for the packages"
    log, = machine.temporary.iterdir()
    assert str(log) in done.stderr


def test_setup_without_apt(machine):
    for command in ("bash", "dirname", "grep"):
        (machine.bin / command).symlink_to(shutil.which(command))
    (machine.bin / "apt-get").unlink()
    refused(machine.run("setup.sh", path=str(machine.bin)), "setup", "no apt-get", "scripts/packages.txt")


def test_setup_again_does_nothing(machine):
    machine.has("dpkg-query", "echo install ok installed")
    machine.has("cmake", "exit 0")
    machine.has("id", "echo 1000")  # nor does it need root
    for _ in range(2):
        done = machine.run("setup.sh")
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert not machine.called("apt-get")
    assert not list(machine.temporary.iterdir()) and not machine.prefix.exists()


def nothing_built(machine):
    """Nothing is installed, and nothing left but the lock."""
    return not list(machine.prefix.rglob("*")) and {path.name for path in machine.temporary.iterdir()} <= {"sas_motion-gtsam.lock"}


def test_gtsam_without_network_names_the_archive(machine):
    refused(machine.run("build_gtsam.sh"), "build_gtsam", ARCHIVE, "network", "Could not resolve")
    assert nothing_built(machine)


def test_gtsam_that_is_not_in_the_archive(machine):
    machine.has("apt-get", OFFLINE.replace("exit 100 ;;", "exit 0 ;;", 1))
    refused(machine.run("build_gtsam.sh"), "build_gtsam", ARCHIVE, "Unable to locate package")
    assert nothing_built(machine)


@pytest.mark.parametrize("fetched, problem", [("gtsam_4.2.0+dfsg.orig.tar.xz", "checksum"), ("gtsam_4.3.0.orig.tar.xz", "version")])
def test_gtsam_with_a_wrong_source(fetched, problem, machine):
    machine.has("apt-get", f"case \"$*\" in *indextargets*) echo {ARCHIVE} ;; *\" source \"*) echo nonsense >{fetched} ;; esac")
    refused(machine.run("build_gtsam.sh"), "build_gtsam", ARCHIVE, problem)
    assert nothing_built(machine)


def test_gtsam_without_a_debian_archive(machine):
    machine.has("apt-get", "echo http://archive.example/ubuntu/")
    refused(machine.run("build_gtsam.sh"), "build_gtsam", "no Debian archive")
    assert nothing_built(machine)


def test_gtsam_without_disk(machine):
    machine.has("df", "echo Avail; echo 17")
    refused(machine.run("build_gtsam.sh"), "build_gtsam", "3 GB", "17 MB")
    assert nothing_built(machine) and not machine.called("apt-get")


def test_gtsam_without_the_right_to_write(machine, tmp_path):
    (tmp_path / "file").write_text("")
    machine.prefix = tmp_path / "file" / "gtsam"  # not even root could make it
    refused(machine.run("build_gtsam.sh"), "build_gtsam", str(machine.prefix), "GTSAM_PREFIX")
    assert not list(machine.temporary.iterdir()) and not machine.called("apt-get")


def test_gtsam_again_does_nothing(machine):
    machine.has("cmake", "exit 0")
    done = machine.run("build_gtsam.sh")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert not machine.called("apt-get") and not list(machine.temporary.iterdir())
