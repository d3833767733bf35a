# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Readings to ROS messages, by REP-103: SI, east-north-up, x forward."""
from __future__ import annotations

import math

import genpy
from geometry_msgs.msg import TransformStamped, TwistWithCovarianceStamped
from sensor_msgs.msg import Imu, NavSatFix, NavSatStatus
from tf2_msgs.msg import TFMessage

from sas_motion_nmea.clock import Reading
from sas_motion_nmea.sentences import SECOND

SIGMA_PER_HDOP = 2.5  # [m]
LEAST_SIGMA = 1.0  # of a fix [m]
TILT_VARIANCE = 0.01  # roll and pitch are taken as level [rad^2]
UNMEASURED = 1e6  # variance of a velocity that a log cannot tell [m^2/s^2]


def stamp(time: int) -> genpy.Time:
    """ns since 1970 to a ROS time."""
    return genpy.Time(time // SECOND, time % SECOND)


def nav_sat_fix(reading: Reading) -> NavSatFix:
    """A fix, or a NO_FIX with NaN where the receiver has no place; altitude is NaN where unknown."""
    fix, message = reading.value, NavSatFix()
    message.header.frame_id = "gnss_link"
    message.status.status = NavSatStatus.STATUS_FIX if fix.valid else NavSatStatus.STATUS_NO_FIX
    message.status.service = NavSatStatus.SERVICE_GPS
    message.latitude, message.longitude, message.altitude = fix.latitude, fix.longitude, fix.altitude
    if fix.valid and fix.hdop is not None:
        variance = max(SIGMA_PER_HDOP * fix.hdop, LEAST_SIGMA) ** 2
        message.position_covariance[0] = message.position_covariance[4] = variance
        message.position_covariance[8] = 4.0 * variance  # the vertical is about twice as bad
        message.position_covariance_type = NavSatFix.COVARIANCE_TYPE_APPROXIMATED
    return message


def imu(reading: Reading, sigma: float) -> Imu:
    """A true heading to an orientation: yaw = pi/2 - heading, level; rates and accelerations absent. sigma [rad]."""
    yaw = math.remainder(math.pi / 2 - math.radians(reading.value.degrees), 2 * math.pi)
    message = Imu()
    message.header.frame_id = "imu_link"
    message.orientation.z, message.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    message.orientation_covariance[0] = message.orientation_covariance[4] = TILT_VARIANCE
    message.orientation_covariance[8] = sigma**2
    message.angular_velocity_covariance[0] = -1.0
    message.linear_acceleration_covariance[0] = -1.0
    return message


def twist(reading: Reading, sigma: float) -> TwistWithCovarianceStamped:
    """Speed through the water, forward; sigma [m/s]. All else is unmeasured."""
    message = TwistWithCovarianceStamped()
    message.header.frame_id = "dvl_link"
    message.twist.twist.linear.x = reading.value.through_water
    covariance = [0.0] * 36
    for i in range(6):
        covariance[7 * i] = sigma**2 if i == 0 else UNMEASURED
    message.twist.covariance = covariance
    return message


def static_transforms(time: int) -> TFMessage:
    """Each sensor at base_link: a log does not tell the lever arms."""
    transforms = []
    for child in ("gnss_link", "imu_link", "dvl_link"):
        transform = TransformStamped()
        transform.header.stamp, transform.header.frame_id = stamp(time), "base_link"
        transform.child_frame_id, transform.transform.rotation.w = child, 1.0
        transforms.append(transform)
    return TFMessage(transforms)
