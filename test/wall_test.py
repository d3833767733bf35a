#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The ROS wall: the core includes no ROS and no GTSAM, the factor graph no ROS.

usage: wall_test.py SOURCE_DIR    exit status 1 where an include crosses the wall
The check first tries itself on a small tree with known violations.
"""
import pathlib
import re
import sys
import tempfile

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')
ROS = re.compile(r'^(ros|rosbag|rosconsole|roscpp|rosgraph_msgs|tf|tf2|tf2_ros|tf2_\w+|nodelet|pluginlib|class_loader|topic_tools|'
                 r'message_filters|diagnostic_updater|dynamic_reconfigure|\w+_msgs|std_srvs|sas_motion_msgs)/'
                 r'|^sas_motion/(ros|bag|tools)/'
                 r'|^sas_motion/[A-Z]\w*\.h$')  # generated messages and services
GTSAM = re.compile(r'^gtsam(_unstable)?/|^sas_motion/smoothers/factor_graph/')
OUTSIDE = {'ros', 'bag', 'tools'}


def violations(root):
    """(file, line, include) of every include that crosses the wall, and the number of files looked at."""
    found, looked = [], 0
    for top in (root / 'include' / 'sas_motion', root / 'src'):
        for path in sorted(top.rglob('*')):
            parts = path.relative_to(top).parts
            if path.suffix not in {'.hpp', '.h', '.cpp'} or parts[0] in OUTSIDE:
                continue
            looked += 1
            graph = 'factor_graph' in parts
            for number, line in enumerate(path.read_text(encoding='utf-8').splitlines(), 1):
                match = INCLUDE.match(line)
                if match and (ROS.match(match[1]) or (not graph and GTSAM.match(match[1]))):
                    found.append((path.relative_to(root).as_posix(), number, match[1]))
    return found, looked


def check_the_check():
    files = {
        'include/sas_motion/filters/a.hpp': ('#include <ros/ros.h>\n', 1),
        'include/sas_motion/filters/b.hpp': ('#include <Eigen/Core>\n#include "sas_motion/math/types.hpp"\n', 0),
        'src/filters/c.cpp': ('#  include "sensor_msgs/NavSatFix.h"\n#include <tf2_ros/buffer.h>\n', 2),
        'src/smoothers/d.cpp': ('#include <gtsam/nonlinear/Values.h>\n', 1),
        'src/smoothers/factor_graph/e.cpp': ('#include <gtsam/nonlinear/Values.h>\n#include <nodelet/nodelet.h>\n', 1),
        'src/pipeline/f.cpp': ('#include "sas_motion/smoothers/factor_graph/batch.hpp"\n#include <sas_motion/Audit.h>\n', 2),
        'src/ros/g.cpp': ('#include <ros/ros.h>\n', 0),
        'src/tools/h.cpp': ('#include <rosbag/bag.h>\n', 0),
        'src/math/i.cpp': ('// #include <ros/ros.h>\n', 0),
    }
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, (text, _) in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding='utf-8')
        found = [name for name, _, _ in violations(root)[0]]
    wrong = [name for name, (_, expected) in files.items() if found.count(name) != expected]
    if wrong:
        sys.exit(f'wall_test: the check itself is wrong about {", ".join(wrong)}')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    check_the_check()
    found, looked = violations(pathlib.Path(sys.argv[1]))
    for name, number, include in found:
        print(f'{name}:{number}: includes {include}, which lies on the other side of the wall')
    if looked < 20:
        sys.exit(f'wall_test: only {looked} files found below {sys.argv[1]}; is this the source folder?')
    print(f'{looked} files, {len(found)} violations')
    sys.exit(1 if found else 0)


if __name__ == '__main__':
    main()
