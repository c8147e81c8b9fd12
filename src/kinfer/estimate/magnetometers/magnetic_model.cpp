// SPDX-License-Identifier: Apache-2.0
#include "kinfer/estimate/magnetometers/magnetic_model.hpp"

#include <algorithm>

namespace kinfer {

using Index = Eigen::Index;

const std::array<Mat3, 9>& soft_iron_basis() {
  static const std::array<Mat3, 9> basis = [] {
    std::array<Mat3, 9> b;
    b.fill(Mat3::Zero());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Index>((k + 1) % 3), j = static_cast<Index>((k + 2) % 3), d = static_cast<Index>(k);
      b[k](d, d) = 1.0;
      b[3 + k](i, j) = b[3 + k](j, i) = 1.0;
      b[6 + k](i, j) = -1.0, b[6 + k](j, i) = 1.0;
    }
    return b;
  }();
  return basis;
}

MagneticModel::MagneticModel(const MagneticRecording& recording, const std::vector<SubtreeRotation>& rotations)
    : recording_(recording), rotations_(rotations) {
  for (const MagneticSeries& series : recording.sensors) {
    std::vector<std::size_t> acting;
    for (const std::size_t body : series.path)
      for (std::size_t k = 0; k < rotations.size(); ++k)
        if (rotations[k].child == body) acting.push_back(k);
    acting_.push_back(std::move(acting));
  }
}

Index MagneticModel::first_iron(std::size_t series) const {
  return rotations() + 3 + iron_unknowns * static_cast<Index>(series);
}

Index MagneticModel::unknowns() const {
  return first_iron(recording_.sensors.size());
}

Mat3 MagneticModel::orientation(const MagneticUnknowns& x, std::size_t series, std::size_t bin) const {
  Mat3 product = Mat3::Identity();
  for (const std::size_t k : acting_[series])
    product *= exp_so3(x.rotation[static_cast<Index>(k)] * rotations_[k].axis[bin]);
  return product * recording_.sensors[series].root_R_sensor[bin];
}

Vec3 MagneticModel::residual(const MagneticUnknowns& x, std::size_t series, std::size_t bin) const {
  const Vec3 truth = orientation(x, series, bin).transpose() * x.field;
  return recording_.sensors[series].field[bin] - truth - x.soft_iron[series] * truth - x.hard_iron[series];
}

MagneticPrediction MagneticModel::predict(const MagneticUnknowns& x, std::size_t series, std::size_t bin) const {
  const Mat3 scale = Mat3::Identity() + x.soft_iron[series];
  const std::vector<std::size_t>& acting = acting_[series];
  MagneticPrediction p{Vec3::Zero(),
                       Eigen::Matrix<double, 3, Eigen::Dynamic>::Zero(3, rotations() + 3 + iron_unknowns)};
  Mat3 after = recording_.sensors[series].root_R_sensor[bin];  // what follows a rotation, from the outside in
  for (auto k = acting.rbegin(); k != acting.rend(); ++k) {
    const Vec3& axis = rotations_[*k].axis[bin];
    Mat3 before = Mat3::Identity();
    for (auto inner = acting.begin(); *inner != *k; ++inner)
      before *= exp_so3(x.rotation[static_cast<Index>(*inner)] * rotations_[*inner].axis[bin]);
    const Mat3 turn = exp_so3(x.rotation[static_cast<Index>(*k)] * axis);
    const Vec3 field = turn.transpose() * (before.transpose() * x.field);
    p.derivative.col(static_cast<Index>(*k)) = scale * (after.transpose() * field.cross(axis));
    after = turn * after;
  }
  const Vec3 truth = after.transpose() * x.field;
  const Index field = rotations(), hard = field + 3, soft = hard + 3;
  p.value = scale * truth + x.hard_iron[series];
  p.derivative.middleCols<3>(field) = scale * after.transpose();
  p.derivative.middleCols<3>(hard).setIdentity();
  for (std::size_t i = 0; i < 9; ++i) p.derivative.col(soft + static_cast<Index>(i)) = soft_iron_basis()[i] * truth;
  return p;
}

MagneticUnknowns MagneticModel::retract(const MagneticUnknowns& x, ConstVectorRef step) const {
  MagneticUnknowns result = x;
  result.rotation += step.head(rotations());
  result.field += step.segment<3>(rotations());
  for (std::size_t s = 0; s < x.hard_iron.size(); ++s) {
    const Index first = first_iron(s);
    result.hard_iron[s] += step.segment<3>(first);
    for (std::size_t i = 0; i < 9; ++i)
      result.soft_iron[s] += step[first + 3 + static_cast<Index>(i)] * soft_iron_basis()[i];
  }
  return result;
}

}  // namespace kinfer
