#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""How long the filter nodelets take from callback to publication at 100 messages a second, by their own diagnostics.

Alone: the nodelet (kf and robust_kf), rosbag play, and a recorder of both odometries. Together: compare.launch, which adds the smoother in the
same manager and a recorder of everything. Ins, sins: the nodelet of INS, GPS and DVL (robust_kf27), of SINS and DVL (ss_srupf), alone. usage: nodelet_latency.py TOOLS OUT SECONDS [RUNS]
"""
import contextlib
import os
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time

import rosbag
import rosgraph

SCENARIO = 'config/scenarios/survey_outliers_10.yaml'
RATE = 100 / 16.0  # the scenario has 16 messages a second
ESTIMATORS = '[kf, robust_kf]'
INS_SCENARIO = 'config/scenarios/ins/survey.yaml'  # 107 messages a second
SINS_SCENARIO = 'config/scenarios/sins_dvl/large_angle.yaml'  # 102 messages a second, of which two move 1200 particles
KEYS = ('callback to publication p50 [ms]', 'callback to publication p99 [ms]', 'whole callback p99 [ms]')


def new_master():
    """Points the environment at a free port; the port."""
    with socket.socket() as s:
        s.bind(('127.0.0.1', 0))
        port = s.getsockname()[1]
    os.environ.update(ROS_IP='127.0.0.1', ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_HOME=tempfile.mkdtemp())
    return str(port)


def quietly(*command):
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)


@contextlib.contextmanager
def running(*command):
    process = quietly(*command)
    try:
        yield process
    finally:
        os.killpg(process.pid, signal.SIGINT)
        process.wait(30)


def wait_until(ready, seconds=30):
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            sys.exit('nodelet_latency: a node did not start')
        time.sleep(0.1)


def names(master, kind):
    """All that is published (0), subscribed to (1) or served (2)."""
    with contextlib.suppress(OSError, rosgraph.MasterException):
        return {name for name, _ in master.getSystemState()[kind]}
    return set()


def last_diagnostics(bag, estimator):
    """Those of the nodelet that runs the estimator."""
    values = {}
    with rosbag.Bag(bag) as live:
        for _, message, _ in live.read_messages(topics=['/diagnostics']):
            for status in message.status:
                found = {v.key: v.value for v in status.values}
                if any(key.startswith(f'{estimator} ') for key in found):
                    values = found
    return [float(values[key]) for key in KEYS]


def alone(bag, recorded, kind='FilterNodelet', estimators=ESTIMATORS, rate=RATE, config=''):
    """Of a nodelet by itself."""
    names_of_estimators = [name.strip() for name in estimators.strip('[]').split(',')]
    odometries = [f'/{name}/odometry' for name in names_of_estimators]
    port = new_master()
    with running('roscore', '-p', port):
        master = rosgraph.Master('/nodelet_latency')
        wait_until(master.is_online)
        subprocess.run(['rosparam', 'set', '/filters', f'{{estimators: {estimators}, config: "{config}"}}'], check=True)
        with running('rosrun', 'nodelet', 'nodelet', 'standalone', f'sas_motion/{kind}', '__name:=filters'):
            wait_until(lambda: '/filters/reset' in names(master, 2))
            with running('rosbag', 'record', '--buffsize=0', '-O', recorded, '/diagnostics', *odometries):
                wait_until(lambda: odometries[0] in names(master, 1))
                subprocess.run(['rosbag', 'play', '--quiet', '--delay=2', f'--rate={rate}', bag, '--topics', 'gnss/fix', 'imu/data', 'dvl/twist', 'depth/pose', 'gnss/velocity',
                                '/tf_static'],
                               check=True, stdout=subprocess.DEVNULL)
                time.sleep(2)
    return last_diagnostics(recorded, names_of_estimators[-1])


def together(bag, recorded):
    port = new_master()
    launch = quietly('roslaunch', '--port', port, 'sas_motion', 'compare.launch', f'bag:={bag}', f'output:={recorded}', f'rate:={RATE}', f'filters:={ESTIMATORS}')
    if launch.wait() != 0:
        sys.exit('nodelet_latency: compare.launch failed')
    return last_diagnostics(recorded, 'robust_kf')


def main():
    tools, out, seconds = sys.argv[1], sys.argv[2], float(sys.argv[3])
    runs = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    bag = f'{out}/latency.bag'
    subprocess.run([f'{tools}/simulate', f'{root}/{SCENARIO}', '-o', bag, '--duration', str(seconds * RATE)], check=True)
    ins_bag, sins_bag = f'{out}/latency_ins.bag', f'{out}/latency_sins.bag'
    for scenario, file in ((INS_SCENARIO, ins_bag), (SINS_SCENARIO, sins_bag)):
        subprocess.run([f'{tools}/simulate', f'{root}/{scenario}', '-o', file, '--duration', str(seconds)], check=True)

    def ins(_, recorded):
        return alone(ins_bag, recorded, 'InsFilterNodelet', '[robust_kf27]', 1)

    def sins(_, recorded):
        return alone(sins_bag, recorded, 'InsFilterNodelet', '[ss_srupf]', 1, f'{root}/config/sins_dvl.yaml')

    for measure in (alone, together, ins, sins):
        found = [measure(bag, f'{out}/latency_of_{measure.__name__}.bag') for _ in range(runs)]
        for key, values in zip(KEYS, zip(*found)):
            print(f'{measure.__name__:<10}{key:<36} best {min(values):.3f}  typical {statistics.median(values):.3f}  worst {max(values):.3f}')


if __name__ == '__main__':
    main()
