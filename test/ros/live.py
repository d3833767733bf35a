# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""A nodelet under test: what it is fed, and what it answers."""
import collections
import contextlib
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

    def __init__(self, session):
        rospy.init_node("tests", disable_signals=True, disable_rostime=True)
        self.session = session
        self.transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        self.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10000) for topic, kind in TYPES.items()}

    def feed(self, messages):
        """Publishes (topic, message, ...) at some 2000 messages a second."""
        for count, (topic, message, *_) in enumerate(messages):
            self.publishers[topic].publish(message)
            if count % 20 == 19:
                time.sleep(0.01)


def measurements(bag, seconds=1e9):
    """(topic, message) of the sensors in a bag's first seconds."""
    found = [(topic, message) for topic, message, _ in toolbox.messages(bag, *TYPES)]
    begin = found[0][1].header.stamp
    return [(topic, message) for topic, message in found if (message.header.stamp - begin).to_sec() < seconds]


def quiet(heard, seconds=0.5):
    """Waits until nothing more comes: topics overtake one another, and an older measurement changes the newest answer."""
    count = -1
    while count != len(heard):
        count = len(heard)
        time.sleep(seconds)


class Nodelet:
    """A nodelet in a process of its own, and all that it has said so far."""

    def __init__(self, name, estimators):
        self.name = name
        self.odometry, self.settled, self.updates, self.fixes = (collections.defaultdict(list) for _ in range(4))
        self.datum, self.status = [], []
        kinds = {"odometry": (Odometry, self.odometry), "settled": (Odometry, self.settled), "update": (FilterUpdate, self.updates), "fix": (NavSatFix, self.fixes)}
        self.subscribers = [rospy.Subscriber(f"{estimator}/{leaf}", kind, heard[estimator].append)
                            for estimator in estimators for leaf, (kind, heard) in kinds.items()]
        self.subscribers += [rospy.Subscriber("datum", NavSatFix, self.datum.append), rospy.Subscriber("/diagnostics", DiagnosticArray, self.on_diagnostics)]

    def on_diagnostics(self, array):
        self.status += [status for status in array.status if status.name == f"{self.name}: estimators"]

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
        return wait_until(newest, f"diagnostics of {self.name}; last: {self.status[-1:]}", 15)

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
    try:
        with session.running_process("rosrun", "nodelet", "nodelet", "standalone", f"sas_motion/{kind}", f"__name:={name}") as process:
            for publisher in publishers:
                wait_until(lambda publisher=publisher: publisher.get_num_connections() > others[publisher] or process.poll() is not None,
                           f"/{name} listens to {publisher.name}")
            assert process.poll() is None, process.log.read_text()
            wait_until(lambda: under_test.status and all(s.get_num_connections() > 0 for s in under_test.subscribers), f"the tests listen to /{name}")
            yield under_test
    finally:
        for subscriber in under_test.subscribers:
            subscriber.unregister()
        rospy.delete_param(f"/{name}")
    for publisher in publishers:
        wait_until(lambda publisher=publisher: publisher.get_num_connections() <= others[publisher], f"/{name} has gone")


def transforms_of(bag):
    """The fixed transforms of a bag."""
    return next(message for _, message, _ in toolbox.messages(bag, "tf_static"))
