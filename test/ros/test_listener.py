# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the other tests rest on: a listener hears every message, in order, and tells where one is missing."""
import rospy
from live import Listener
from ros_session import wait_until
from sensor_msgs.msg import NavSatFix


def test_a_listener_hears_all_and_tells_what_is_missing(session, sensors):
    listener, publisher = Listener("a/fix", NavSatFix), rospy.Publisher("a/fix", NavSatFix, queue_size=10000)
    wait_until(listener.connected, "a connection")
    for latitude in range(5000):
        publisher.publish(NavSatFix(latitude=latitude))
    wait_until(lambda: len(listener) == 5000, "all messages")
    assert [fix.latitude for fix in listener] == list(range(5000)) and listener.lost() == 0
    # WHEN three are lost on the way THEN it says so
    publisher.impl.seq += 3
    publisher.publish(NavSatFix())
    wait_until(lambda: len(listener) == 5001, "the last message")
    assert listener.lost() == 3
    listener.close()
    publisher.unregister()
