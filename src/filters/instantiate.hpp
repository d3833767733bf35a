// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The one list of the state and measurement sizes that the filters are compiled for.
#pragma once

#define SAS_MOTION_FOR_STATES(DO) DO(2) DO(6)

#define SAS_MOTION_INSTANTIATE_UPDATE(Filter, N, M)                                                                    \
  template Update<Filter<N>::Belief, M> Filter<N>::update<M>(const Filter<N>::Belief&, const LinearMeasurement<N, M>&) \
      const;

// For the filters whose belief is one Gaussian.
#define SAS_MOTION_INSTANTIATE_LARGE_UPDATES(Filter) \
  template class Filter<27>;                         \
  SAS_MOTION_INSTANTIATE_UPDATE(Filter, 27, 1)       \
  SAS_MOTION_INSTANTIATE_UPDATE(Filter, 27, 2)       \
  SAS_MOTION_INSTANTIATE_UPDATE(Filter, 27, 3)

#define SAS_MOTION_INSTANTIATE_UPDATES(Filter) \
  template class Filter<2>;                    \
  template class Filter<6>;                    \
  SAS_MOTION_INSTANTIATE_UPDATE(Filter, 2, 1)  \
  SAS_MOTION_INSTANTIATE_UPDATE(Filter, 6, 1)  \
  SAS_MOTION_INSTANTIATE_UPDATE(Filter, 6, 2)  \
  SAS_MOTION_INSTANTIATE_UPDATE(Filter, 6, 4)
