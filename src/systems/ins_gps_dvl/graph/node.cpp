// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#include "systems/ins_gps_dvl/graph/node.hpp"

#include <iostream>

namespace sas_motion::ins {

Node Node::retract(const Vector<kNodeStates>& e) const {
  Node moved = *this;
  moved.state.velocity_nav += e.segment<3>(kVelocity);
  displace(moved.state, e.segment<3>(kPosition));
  const Vector<3> phi = kMilliradian * e.segment<3>(kAttitude);
  moved.state.q_nav_body =
      Eigen::Quaterniond(Eigen::AngleAxisd(-phi.norm(), phi.stableNormalized())) * state.q_nav_body;
  moved.state.q_nav_body.normalize();
  moved.wandering += e.tail<9>();
  return moved;
}

Vector<kNodeStates> Node::localCoordinates(const Node& computed) const {
  Vector<kNodeStates> e;
  e << computed.state.velocity_nav - state.velocity_nav, displacement(state, computed.state),
      attitudeError(computed.state.q_nav_body, state.q_nav_body) / kMilliradian, computed.wandering - wandering;
  return e;
}

void Node::print(const std::string& prefix) const {
  std::cout << prefix << state.latitude << " " << state.longitude << " " << state.height << " "
            << state.velocity_nav.transpose() << " " << state.q_nav_body.coeffs().transpose() << " "
            << wandering.transpose() << "\n";
}

bool Node::equals(const Node& other, double tolerance) const {
  return localCoordinates(other).cwiseAbs().maxCoeff() <= tolerance;
}

Errors errorsOf(const Node& node, const Constants& constants) {
  Errors e = Errors::Zero();
  e.segment<3>(kGyroConstant) = constants.head<3>();
  e.segment<3>(kAccelerometer) = constants.tail<3>();
  e.segment<3>(kGyroMarkov) = node.wandering.head<3>();
  e.segment<3>(kGpsPosition) = node.wandering.segment<3>(3);
  e.segment<3>(kDvlVelocity) = node.wandering.tail<3>();
  return e;
}

Node nodeOf(const NavigationState& fused, const Errors& mean) {
  Node node;
  node.state = fused;
  node.wandering << mean.segment<3>(kGyroMarkov), mean.segment<3>(kGpsPosition), mean.segment<3>(kDvlVelocity);
  return node;
}

Constants constantsOf(const Errors& mean) {
  Constants constants;
  constants << mean.segment<3>(kGyroConstant), mean.segment<3>(kAccelerometer);
  return constants;
}

}  // namespace sas_motion::ins
