#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Plays a bag once everybody listens, waits until everything is settled, and ends: with required="true" that ends a launch in order."""
import argparse
import subprocess
import sys
import time

import rosbag
import rosgraph
import rospy
from std_srvs.srv import Trigger


def wait_until(ready, what, timeout):
    """Waits for ready() to be true; ends the node with a plain sentence after `timeout` seconds."""
    end = time.monotonic() + timeout
    while not ready():
        if time.monotonic() > end or rospy.is_shutdown():
            sys.exit(f'play_session: {what} did not appear within {timeout:g} s')
        time.sleep(0.05)


def subscribers_of(master, topic):
    """Names of the nodes that subscribe to a topic."""
    for name, nodes in master.getSystemState()[1]:
        if name == topic:
            return nodes
    return []


def sensor_topics(path):
    """The topics of a bag, with a leading slash, and its duration [s]."""
    with rosbag.Bag(path) as bag:
        return ['/' + t.lstrip('/') for t in bag.get_type_and_topic_info().topics], bag.get_end_time() - bag.get_start_time()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('bag')
    parser.add_argument('--rate', type=float, default=1, help='times real time')
    parser.add_argument('--wait-for', nargs='*', default=[], help='services that must be there first')
    parser.add_argument('--recorder', help='node that must listen first')
    parser.add_argument('--solve', help='service to call at the end')
    parser.add_argument('--settle', type=float, default=5, help='seconds to wait after the bag\'s end')
    return parser.parse_args(rospy.myargv()[1:])


def main():
    options = arguments()
    rospy.init_node('play_session', disable_rostime=True)
    master = rosgraph.Master(rospy.get_name())
    for service in options.wait_for:
        rospy.wait_for_service(service, timeout=60)
    if options.recorder:
        wait_until(lambda: options.recorder in subscribers_of(master, '/datum'), f'the recorder {options.recorder}', 30)
    _, duration = sensor_topics(options.bag)
    print(f'play_session: playing {options.bag}, {duration:.0f} s at {options.rate:g} times real time', flush=True)
    player = subprocess.run(['rosbag', 'play', '--quiet', '--delay=2', '--queue=10000', f'--rate={options.rate}', options.bag], check=False)
    if player.returncode != 0:
        sys.exit(f'play_session: rosbag play ended with status {player.returncode}')
    time.sleep(options.settle)
    if options.solve:
        answer = rospy.ServiceProxy(options.solve, Trigger)()
        print(f'play_session: {options.solve}: {answer.message}', flush=True)
        time.sleep(options.settle)
        if not answer.success:
            sys.exit(1)


if __name__ == '__main__':
    main()
