# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ship's NMEA 0183 logs to ROS messages: sentences, their times, the choice among sources, the messages."""
