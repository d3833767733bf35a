#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Plays a bag once everybody listens, waits until everything is settled, and ends: with required="true" that ends a launch in order."""
import argparse
import re
import subprocess
import sys
import time
import xmlrpc.client

import rosbag
import rosgraph
import rospy
from std_srvs.srv import SetBool, Trigger

PATIENCE = 120  # seconds within which a node must appear
PERIODIC = {'/rosout', '/diagnostics'}  # topics on which there is always something


def wait_until(ready, what, timeout=PATIENCE):
    """Waits for ready() to be true and returns it; ends the node with a plain sentence after `timeout` seconds."""
    end = time.monotonic() + timeout
    while True:
        found = ready()
        if found:
            return found
        if time.monotonic() > end or rospy.is_shutdown():
            sys.exit(f'play_session: {what}: not within {timeout:g} s')
        time.sleep(0.05)


def api_of(master, node):
    """Where a node answers questions about its connections."""
    return xmlrpc.client.ServerProxy(master.lookupNode(node))


def published(master):
    """Nodes by the topic that they publish."""
    return dict(master.getSystemState()[0])


def links_from(master, publisher):
    """(publisher, topic, subscriber) of all who have asked for a node's topics."""
    publishers, subscribers, _ = master.getSystemState()
    topics = {topic for topic, nodes in publishers if publisher in nodes}
    return {(publisher, topic, node) for topic, nodes in subscribers if topic in topics for node in nodes if node != publisher}


def unconnected(master, links):
    """Those of the links that do not stand yet: until then a subscriber that has asked for a topic hears nothing of it."""
    left = set(links)
    for subscriber in {link[2] for link in links}:
        for _, source, direction, _, topic, connected, *_ in api_of(master, subscriber).getBusInfo(master.caller_id)[2]:
            if direction == 'i' and connected:
                left -= {link for link in links if link[1:] == (topic, subscriber) and source in (link[0], master.lookupNode(link[0]))}
    return left


def links_to_recorder(master, recorder, patterns):
    """(publisher, topic, recorder) of all that it is to record."""
    return {(node, topic, recorder) for topic, nodes in published(master).items() if any(re.fullmatch(p, topic) for p in patterns) for node in nodes if node != recorder}


def traffic(master, node):
    """How many messages a node has received over the connections that stand, and how many of them it dropped since it could not keep up."""
    _, subscriptions, *_ = api_of(master, node).getBusStats(master.caller_id)  # as roscpp answers: without a status before it
    counts = [(received, dropped) for topic, links in subscriptions if topic not in PERIODIC for _, _, received, dropped, _ in links]
    return sum(received for received, _ in counts), sum(dropped for _, dropped in counts)


def topics_of(path):
    """The topics of a bag, with a leading slash, and its duration [s]."""
    with rosbag.Bag(path) as bag:
        return {'/' + t.lstrip('/') for t in bag.get_type_and_topic_info().topics}, bag.get_end_time() - bag.get_start_time()


def play(master, bag, rate, recorder, patterns):
    """Plays a bag to its end, from when all who have asked for its topics are connected."""
    topics, duration = topics_of(bag)
    player = rospy.get_name() + '_player'
    process = subprocess.Popen(['rosbag', 'play', '--quiet', '--pause', '--queue=10000', f'--rate={rate}', bag, '__name:=' + player.strip('/')])

    def everybody_listens():
        if process.poll() is not None:
            return True
        if any(player not in published(master).get(topic, []) for topic in topics):
            return False
        links = links_from(master, player) | (links_to_recorder(master, recorder, patterns) if recorder else set())
        return not unconnected(master, links)
    try:
        wait_until(everybody_listens, 'all connections')
        if process.poll() is None:
            print(f'play_session: playing {bag}, {duration:.0f} s at {rate:g} times real time', flush=True)
            rospy.wait_for_service(f'{player}/pause_playback', PATIENCE)
            rospy.ServiceProxy(f'{player}/pause_playback', SetBool)(False)
        if process.wait() != 0:
            sys.exit(f'play_session: rosbag play ended with status {process.returncode}')
    finally:
        if process.poll() is None:
            process.terminate()


def settle(master, recorder, seconds):
    """Waits until nothing more is recorded for so many seconds, or without a recorder so many seconds."""
    count = None
    while count is None or (recorder and count != traffic(master, recorder)[0]):
        count = traffic(master, recorder)[0] if recorder else 0
        time.sleep(seconds)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('bag')
    parser.add_argument('--rate', type=float, default=1, help='times real time')
    parser.add_argument('--wait-for', nargs='*', default=[], help='services that must be there first')
    parser.add_argument('--recorder', help='node that must listen first')
    parser.add_argument('--recorded', nargs='*', default=[], help='regular expressions of the topics that it records')
    parser.add_argument('--solve', help='service to call at the end')
    parser.add_argument('--settle', type=float, default=5, help='seconds of silence after the bag\'s end')
    return parser.parse_args(rospy.myargv()[1:])


def main():
    options = arguments()
    rospy.init_node('play_session', disable_rostime=True)
    master = rosgraph.Master(rospy.get_name())
    for service in options.wait_for:
        rospy.wait_for_service(service, timeout=PATIENCE)
    if options.recorder:
        wait_until(lambda: any(options.recorder in nodes for nodes in published(master).values()), f'the recorder {options.recorder}')
    play(master, options.bag, options.rate, options.recorder, options.recorded)
    settle(master, options.recorder, options.settle)
    solved = True
    if options.solve:
        answer = rospy.ServiceProxy(options.solve, Trigger)()
        solved = answer.success
        print(f'play_session: {options.solve}: {answer.message}', flush=True)
        settle(master, options.recorder, options.settle)
    dropped = traffic(master, options.recorder)[1] if options.recorder else 0
    if dropped:
        print(f'play_session: the recording lacks {dropped} messages, since the recorder did not keep up; play it at a lower rate', flush=True)
    if not solved:
        sys.exit(1)


if __name__ == '__main__':
    main()
