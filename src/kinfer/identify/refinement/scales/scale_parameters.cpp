// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/refinement/scales/scale_parameters.hpp"

#include "kinfer/geometry/rotation.hpp"

namespace kinfer::identify::scale_parameters {

using Index = Eigen::Index;

VectorXd scale_priors(const InsProblem& problem, const std::vector<InsScaleFactor>& factors) {
  VectorXd sd(each * static_cast<Index>(problem.sensors.size()));
  for (std::size_t s = 0; s < problem.sensors.size(); ++s) {
    const InsScaleFactor factor = factors.empty() ? InsScaleFactor{} : factors[s];
    const Index at = each * static_cast<Index>(s);
    sd.segment<elements>(at).setConstant(factor.gyroscope * problem.prior.gyroscope_scale);
    sd.segment<elements>(at + elements).setConstant(factor.accelerometer * problem.prior.accelerometer_scale);
  }
  return sd;
}

MatrixXd scale_information(const VectorXd& sd, const InsCommonScales& common) {
  const VectorXd own = sd.array().square().inverse();
  MatrixXd information = own.asDiagonal();
  const auto sensors = static_cast<std::size_t>(sd.size() / each);
  const auto share = [&](InsInstrument instrument, const InsCommonScale& scale) {
    if (scale.is_none()) return;
    const VectorXd factor = common_factor(sensors, instrument), weighted = own.cwiseProduct(factor);
    information -= weighted * weighted.transpose() / (1.0 / (scale.sd * scale.sd) + factor.dot(weighted));
  };
  share(InsInstrument::gyroscope, common.gyroscope);
  share(InsInstrument::accelerometer, common.accelerometer);
  return information;
}

VectorXd scale_values(const std::vector<InsErrors>& errors) {
  VectorXd values(each * static_cast<Index>(errors.size()));
  for (std::size_t s = 0; s < errors.size(); ++s) {
    const Index at = each * static_cast<Index>(s);
    values.segment<elements>(at) = Eigen::Map<const VectorXd>(errors[s].gyroscope_scale.data(), elements);
    values.segment<elements>(at + elements) =
        Eigen::Map<const VectorXd>(errors[s].accelerometer_scale.data(), elements);
  }
  return values;
}

std::vector<Index> indices_of_scales(const InsLayout& layout) {
  std::vector<Index> all;
  for (const Index error : layout.error)
    for (Index k = 0; k < each; ++k) all.push_back(error + first_scale + k);
  return all;
}

MatrixXd rotations() {
  MatrixXd all(elements, 3);
  for (Index k = 0; k < 3; ++k) {
    const Mat3 generator = skew(Vec3::Unit(k));
    all.col(k) = Eigen::Map<const VectorXd>(generator.data(), elements);
  }
  return all;
}

VectorXd common_factor(std::size_t sensors, InsInstrument instrument) {
  VectorXd factor = VectorXd::Zero(each * static_cast<Index>(sensors));
  for (Index first = instrument == InsInstrument::gyroscope ? 0 : elements; first < factor.size(); first += each)
    for (const Index k : diagonal) factor[first + k] = 1.0;
  return factor;
}

}  // namespace kinfer::identify::scale_parameters
