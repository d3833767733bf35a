# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Other people's filters and smoother on our data. requirements.txt has their versions."""
