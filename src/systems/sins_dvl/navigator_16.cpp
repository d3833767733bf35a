// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/sins_dvl/navigator.hpp"

namespace sas_motion::sins {

template std::unique_ptr<ins::Estimator> makeNavigator<kPaperStates>(const NamedFilter&, const Config&);

}  // namespace sas_motion::sins
