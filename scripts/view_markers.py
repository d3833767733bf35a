#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""For RViz: each estimator's track as nav_msgs/Path (NAME/path), and the fixes it rejected or down-weighted as red spheres (NAME/rejected_fixes)."""
import argparse

import rospy
from geometry_msgs.msg import Point, PoseStamped
from nav_msgs.msg import Odometry, Path
from sas_motion.msg import FilterUpdate
from visualization_msgs.msg import Marker

MOST_POSES = 20000
KEPT_SECONDS = 60


class EstimatorView:
    """Track and rejected fixes of one estimator."""

    def __init__(self, name, spacing):
        self.spacing = spacing
        self.path = Path()
        self.positions = {}  # stamp [ns] -> position, of the last minute
        self.rejected = Marker(type=Marker.SPHERE_LIST, action=Marker.ADD)
        self.rejected.pose.orientation.w = 1
        self.rejected.scale.x = self.rejected.scale.y = self.rejected.scale.z = 1
        self.rejected.color.r = self.rejected.color.a = 1
        self.path_publisher = rospy.Publisher(name + '/path', Path, queue_size=1, latch=True)
        self.marker_publisher = rospy.Publisher(name + '/rejected_fixes', Marker, queue_size=1, latch=True)
        rospy.Subscriber(name + '/odometry', Odometry, self.on_odometry, queue_size=100)
        rospy.Subscriber(name + '/update', FilterUpdate, self.on_update, queue_size=1000)

    def on_odometry(self, odometry):
        position = odometry.pose.pose.position
        now = odometry.header.stamp.to_nsec()
        self.positions[now] = position
        for old in [s for s in self.positions if s < now - KEPT_SECONDS * 10**9]:
            del self.positions[old]
        self.path.header = self.rejected.header = odometry.header
        if self.path.poses:
            last = self.path.poses[-1].pose.position
            if (position.x - last.x) ** 2 + (position.y - last.y) ** 2 < self.spacing ** 2:
                return
        self.path.poses.append(PoseStamped(odometry.header, odometry.pose.pose))
        del self.path.poses[:-MOST_POSES]
        self.path_publisher.publish(self.path)

    def on_update(self, update):
        """Draws a fix with less than half its weight where it was: the state of its stamp plus the innovation."""
        if update.sensor != 'position' or not update.weights or min(update.weights) >= 0.5:
            return
        at = self.positions.get(update.header.stamp.to_nsec())
        if at is None:
            return
        north, east = update.innovation
        self.rejected.points.append(Point(at.x + east, at.y + north, 0))
        del self.rejected.points[:-MOST_POSES]
        self.marker_publisher.publish(self.rejected)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('estimators', nargs='+')
    parser.add_argument('--spacing', type=float, default=0.5, help='metres between points of a track')
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node('view_markers')
    views = [EstimatorView(name, options.spacing) for name in options.estimators]
    rospy.spin()
    del views


if __name__ == '__main__':
    main()
