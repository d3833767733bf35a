// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The one list of the state and measurement sizes that the library has compiled filters for. KIND is `extern` in
// headers, so that users do not compile these sizes again, and empty in the filter's .cpp. Other sizes are compiled
// where they are used.
#pragma once

#define SAS_MOTION_FOR_STATES(KIND, DO) DO(KIND, 2) DO(KIND, 6)

#define SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, N, M)                                   \
  KIND template Update<Filter<N>::Belief, M> Filter<N>::update<M>(const Filter<N>::Belief&, \
                                                                  const LinearMeasurement<N, M>&) const;

// For the filters whose belief is one Gaussian.
#define SAS_MOTION_INSTANTIATE_LARGE_UPDATES(KIND, Filter) \
  KIND template class Filter<27>;                          \
  SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, 27, 1)       \
  SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, 27, 2)       \
  SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, 27, 3)

#define SAS_MOTION_INSTANTIATE_UPDATES(KIND, Filter) \
  KIND template class Filter<2>;                     \
  KIND template class Filter<6>;                     \
  SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, 2, 1)  \
  SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, 6, 1)  \
  SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, 6, 2)  \
  SAS_MOTION_INSTANTIATE_UPDATE(KIND, Filter, 6, 4)
