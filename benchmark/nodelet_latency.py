#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Plays a bag into the filter nodelet at 100 messages a second and prints what its diagnostics say. usage: nodelet_latency.py TOOLS OUT SECONDS"""
import os
import socket
import subprocess
import sys
import tempfile

import rosbag

SCENARIO = 'config/scenarios/survey_outliers_10.yaml'
SENSOR_RATE = 16.0  # messages a second of the scenario


def free_port():
    with socket.socket() as s:
        s.bind(('127.0.0.1', 0))
        return s.getsockname()[1]


def main():
    tools, out, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    rate = 100 / SENSOR_RATE
    bag, recorded = f'{out}/latency.bag', f'{out}/latency_live.bag'
    subprocess.run([f'{tools}/simulate', f'{root}/{SCENARIO}', '-o', bag, '--duration', str(seconds * rate)], check=True)
    port = free_port()
    environment = dict(os.environ, ROS_IP='127.0.0.1', ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_HOME=tempfile.mkdtemp())
    subprocess.run(['roslaunch', '--port', str(port), 'sas_motion', 'compare.launch', f'bag:={bag}', f'output:={recorded}', f'rate:={rate}',
                    'filters:=[kf, robust_kf]'], env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    values = {}
    with rosbag.Bag(recorded) as live:
        for _, message, _ in live.read_messages(topics=['/diagnostics']):
            for status in message.status:
                if any('kf' in v.key for v in status.values):
                    values = {v.key: v.value for v in status.values}
    for key in ('callbacks', 'callback to publication p50 [ms]', 'callback to publication p99 [ms]'):
        print(f'{key:<40}{values[key]}')


if __name__ == '__main__':
    main()
