# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""A ROS master of the tests' own; what is started in it ends with it."""
import contextlib
import os
import pathlib
import signal
import socket
import subprocess
import time

import play_session
import rosgraph
import rospy
from std_srvs.srv import SetBool


def wait_until(ready, what, timeout=120):
    """Waits for ready() to be true and returns it; long, since the machine may be busy."""
    end = time.monotonic() + timeout
    while True:
        found = ready()
        if found:
            return found
        assert time.monotonic() < end, f"{what}: not within {timeout} s"
        time.sleep(0.05)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def end(process, patience=20):
    """Ends a process group that we started, gently first."""
    for how in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        if process.poll() is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, how)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(patience)


class Session:
    """A roscore on a free port."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        port = free_port()
        self.environment = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "ROS_HOME": str(self.folder),
                            "ROS_LOG_DIR": str(self.folder / "log"), "PYTHONDONTWRITEBYTECODE": "1"}
        os.environ.update(self.environment)
        os.environ.pop("ROS_HOSTNAME", None)
        self.running = []
        self.core = self.start("roscore", "-p", port)
        self.master = rosgraph.Master("/tests")
        wait_until(self.master.is_online, "roscore")
        wait_until(lambda: "/rosout" in self.nodes(), "rosout")

    def start(self, *command):
        """A process with its output in process.log."""
        log = self.folder / f"{len(self.running)}.log"
        with open(log, "w") as stream:
            process = subprocess.Popen([str(c) for c in command], stdout=stream, stderr=subprocess.STDOUT, start_new_session=True)
        process.log = log
        self.running.append(process)
        return process

    def nodes(self):
        """Names of the nodes that publish anything."""
        with contextlib.suppress(OSError, rosgraph.MasterException):
            return {node for _, nodes in self.master.getSystemState()[0] for node in nodes}
        return set()

    def subscribers(self, topic):
        """Names of the nodes that subscribe to a topic."""
        return {node for name, nodes in self.master.getSystemState()[1] if name == topic for node in nodes}

    def play(self, player, listener, topics):
        """Lets a paused rosbag play begin, once a node, and who else has asked for its topics, is connected to it."""
        def connected():
            with contextlib.suppress(OSError, rosgraph.MasterException):
                links = play_session.links_from(self.master, player)
                return {(player, f"/{topic}", listener) for topic in topics} <= links and not play_session.unconnected(self.master, links)
            return False
        wait_until(connected, f"{listener} listens to {player}")
        rospy.wait_for_service(f"{player}/pause_playback", 120)
        rospy.ServiceProxy(f"{player}/pause_playback", SetBool)(False)

    @contextlib.contextmanager
    def running_process(self, *command):
        """A process for as long as the block lasts."""
        process = self.start(*command)
        try:
            yield process
        finally:
            end(process)

    def close(self):
        for process in reversed(self.running):
            end(process)


def run_to_end(process, timeout=600):
    """Waits for a process that ends by itself; its exit status."""
    try:
        return process.wait(timeout)
    finally:
        end(process)
