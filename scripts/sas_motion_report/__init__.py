# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables and the HTML report of an evaluation."""


class ReportError(Exception):
    """A failure the user can mend; its text is one plain sentence."""
