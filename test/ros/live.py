# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""A nodelet under test: what it is fed, and what it answers."""
import collections
import contextlib
import struct
import threading
import time

import rospy
import toolbox
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import TwistWithCovarianceStamped
from nav_msgs.msg import Odometry
from ros_session import wait_until
from sas_motion.msg import FilterUpdate
from sensor_msgs.msg import Imu, NavSatFix
from tf2_msgs.msg import TFMessage

TYPES = {"gnss/fix": NavSatFix, "imu/data": Imu, "dvl/twist": TwistWithCovarianceStamped}
# Data run many times faster than their stamps here, so that topics overtake one another by seconds: everything may come as late as this.
PATIENT = {"lag": 30, "frames": {"timeout": 3600}, "estimators": {"fixed_lag": {"reorder": 30}}, "datum": [54.35, 10.15, 0]}


class Sensors:
    """Publishers of the sensors' topics."""

    def __init__(self, session, types=None):
        self.session = session
        self.transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        self.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10000) for topic, kind in (types or TYPES).items()}

    def feed(self, messages):
        """Publishes (topic, message, ...) at some 2000 messages a second."""
        for count, (topic, message, *_) in enumerate(messages):
            self.publishers[topic].publish(message)
            if count % 20 == 19:
                time.sleep(0.01)


def measurements(bag, seconds=1e9, types=None):
    """(topic, message) of the sensors in a bag's first seconds."""
    found = [(topic, message) for topic, message, _ in toolbox.messages(bag, *(types or TYPES))]
    begin = found[0][1].header.stamp
    return [(topic, message) for topic, message in found if (message.header.stamp - begin).to_sec() < seconds]


class Listener:
    """All messages of a topic, in the order of their arrival. They are kept as they come and decoded when they are looked at, so that none
    is lost in a publisher's queue while the tests are busy; what was lost all the same shows as a gap in what the publisher counted."""

    def __init__(self, topic, kind):
        self.topic, self.kind = topic, kind
        self._raw, self._messages, self._lock = [], [], threading.Lock()
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._raw.append, buff_size=1 << 22, tcp_nodelay=True)

    def __len__(self):
        return len(self._raw)

    def __getitem__(self, index):
        with self._lock:
            for raw in self._raw[len(self._messages):]:
                assert raw._connection_header["md5sum"] == self.kind._md5sum, f"{self.topic} is of type {raw._connection_header['type']}"
                self._messages.append(self.kind().deserialize(raw._buff))
            return self._messages[index]

    def __iter__(self):
        return iter(self[:])

    def counted(self):
        """Of each publisher how many messages it has sent so far, as it counts them itself, as a set."""
        found = collections.defaultdict(set)
        for raw in self._raw[:] if self.kind._has_header else []:
            found[raw._connection_header["callerid"]].add(struct.unpack_from("<I", raw._buff)[0])
        return found

    def lost(self):
        """How many messages are missing between those heard."""
        return sum(max(numbers) - min(numbers) + 1 - len(numbers) for numbers in self.counted().values())

    def connected(self):
        return self._subscriber.get_num_connections() > 0

    def close(self):
        self._subscriber.unregister()


@contextlib.contextmanager
def listening(listeners):
    """Closes listeners at the end of the block, and fails where they lost anything."""
    try:
        yield
    finally:
        for listener in listeners:
            listener.close()
        lost = {listener.topic: listener.lost() for listener in listeners if listener.lost()}
        assert not lost, f"the tests themselves lost messages, so that they can tell nothing of the rest: {lost}"


def quiet(heard, seconds=1):
    """Waits until nothing more comes: topics overtake one another, and an older measurement changes the newest answer."""
    count = -1
    while count != len(heard):
        count = len(heard)
        time.sleep(seconds)


def statuses(diagnostics, name):
    """The statuses of a name among what a listener has heard on /diagnostics."""
    return [status for array in diagnostics for status in array.status if status.name == name]


class Nodelet:
    """A nodelet in a process of its own, and all that it has said so far."""

    def __init__(self, name, estimators):
        self.name = name
        kinds = {"odometry": Odometry, "settled": Odometry, "update": FilterUpdate, "fix": NavSatFix}
        self.odometry, self.settled, self.updates, self.fixes = ({e: Listener(f"{e}/{leaf}", kind) for e in estimators} for leaf, kind in kinds.items())
        self.datum, self.diagnostics = Listener("datum", NavSatFix), Listener("/diagnostics", DiagnosticArray)
        self.listeners = [*self.odometry.values(), *self.settled.values(), *self.updates.values(), *self.fixes.values(), self.datum, self.diagnostics]

    @property
    def status(self):
        """What it has said on /diagnostics."""
        return statuses(self.diagnostics, f"{self.name}: estimators")

    def call(self, service, kind, *arguments):
        """The answer of one of its services."""
        return rospy.ServiceProxy(f"/{self.name}/{service}", kind)(*arguments)

    def counts(self, wanted=lambda values: True):
        """The newest values on /diagnostics that are as wanted, and the status that held them."""
        def newest():
            for status in reversed(self.status):
                values = {pair.key: pair.value for pair in status.values}
                if wanted(values):
                    return values, status
            return None
        return wait_until(newest, f"diagnostics of {self.name}; last: {self.status[-1:]}")

    def verdicts(self, estimator):
        """How many measurements an estimator accepted, down-weighted, rejected, found stale, found invalid."""
        counts = [0] * 5
        for update in list(self.updates[estimator]):
            counts[update.verdict] += 1
        return counts


@contextlib.contextmanager
def nodelet(session, sensors, kind, config, estimators, transforms, **parameters):
    """A nodelet that listens to the sensors, for as long as the block lasts."""
    name = kind.replace("Nodelet", "").lower()
    rospy.set_param(f"/{name}", {"config": str(config), "estimators": list(estimators), "idle_timeout": 2.0, **parameters})
    sensors.transforms.publish(transforms)
    publishers = [*sensors.publishers.values(), sensors.transforms]
    others = {publisher: publisher.get_num_connections() for publisher in publishers}
    under_test = Nodelet(name, estimators)
    with listening(under_test.listeners), contextlib.ExitStack() as at_end:
        at_end.callback(rospy.delete_param, f"/{name}")
        process = at_end.enter_context(session.running_process("rosrun", "nodelet", "nodelet", "standalone", f"sas_motion/{kind}", f"__name:={name}"))
        for publisher in publishers:
            wait_until(lambda publisher=publisher: publisher.get_num_connections() > others[publisher] or process.poll() is not None,
                       f"/{name} listens to {publisher.name}")
        assert process.poll() is None, process.log.read_text()
        wait_until(lambda: under_test.status and all(listener.connected() for listener in under_test.listeners), f"the tests listen to /{name}")
        yield under_test
    for publisher in publishers:
        wait_until(lambda publisher=publisher: publisher.get_num_connections() <= others[publisher], f"/{name} has gone")


def transforms_of(bag):
    """The fixed transforms of a bag."""
    return next(message for _, message, _ in toolbox.messages(bag, "tf_static"))
