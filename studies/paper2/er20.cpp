// SPDX-License-Identifier: Apache-2.0
#include "er20.hpp"

#include <fmt/format.h>

#include "kinfer/kinematics/forward.hpp"

namespace kinfer::paper2 {
namespace {

Joint row(double a_mm, double alpha_deg, double d, double lower_deg, double upper_deg) {
  MdhLink link;
  link.a = a_mm * millimetre, link.alpha = alpha_deg * degree, link.d = d;
  Joint joint{.link = link};
  joint.lower = lower_deg * degree, joint.upper = upper_deg * degree;
  return joint;
}

double unit_of(int k) {
  return k % 4 < 2 ? millimetre : degree;
}  // a, d, theta, alpha

}  // namespace

// clang-format off
//                    a_{i-1}  d_i     theta_i alpha_{i-1}
const Table table3{   0.1,    0.05,   0.01,   0.01,
                      0.05,   0.1,    0.015,  0.005,
                      0.065,  0.05,   0.003,  0.015,
                      0.06,   0.008,  0.012,  0.006,
                      0.03,   0.36,   0.008,  0.004,
                      0.25,   0.01,   0.025,  0.125};
const Table table4{   0.0994, 0.0508, 0.01,   0.01,
                      0.0577, 0.5017, 0.0146, 0.005,
                      0.065, -0.3564, 0.0022, 0.0149,
                      0.0396, 0.0115, 0.012,  0.0065,
                      0.035,  0.9515, 0.0039, 0.0043,
                      0.229,  0.0098, 0.9910,-0.0260};
const Table table5{   0.1000, 0.0503, 0.0101, 0.01,
                      0.0508,-0.1087, 0.0149, 0.0049,
                      0.0643, 0.2521, 0.0028, 0.0148,
                      0.0561, 0.0086, 0.0129, 0.0064,
                      0.0306,-0.3314, 0.0352, 0.0046,
                      0.3562, 0.0122, 0.2028, 0.3001};
const Table table6{  -0.303,  1.055,  0.292,  0.006,
                      0.323, -1.227,  0.039,  0.006,
                      0.389, -1.380,  0.063, -0.074,
                     -1.487, -1.400,  0.069,  0.229,
                      0.204, -1.385,  0.441, -0.304,
                      0.053,  0.572,  0.195,  0.338};
const Table table7{  -0.3025, 1.055,  0.292,  0.006,
                      0.352, -1.515,  0.040,  0.009,
                      0.381, -1.545,  0.063, -0.037,
                     -1.487, -1.527,  0.069,  0.286,
                      0.204, -1.374,  0.172, -0.281,
                      0.033,  0.592,  0.447,  0.332};
// clang-format on

Chain er20(double d6) {
  Chain chain;
  chain.name = "ER20-C10";
  chain.joints = {row(0, 0, 0.504, -170, 170),           row(166.605, -90, 0, -130, 40), row(782.270, 0, 0, -60, 140),
                  row(138.826, -90, 0.76135, -180, 180), row(0, 90, 0, -120, 120),       row(0, -90, d6, -180, 180)};
  for (int j = 0; j < 6; ++j) {
    chain.joints[j].name = fmt::format("J{}", j + 1);
    chain.joints[j].parent = j - 1;
  }
  return chain;
}

ParameterSet table2_parameters(const Chain& robot) {
  const ParameterSet all = all_parameters(robot, {});
  ParameterSet set;
  for (int j = 0; j < 6; ++j)
    for (const Field field : {Field::a, Field::d, Field::theta, Field::alpha})
      for (const Parameter& p : all.parameters)
        if (p.at == ParameterAddress{JointNumber{j, field}}) set.parameters.push_back(p);
  return set;
}

VectorXd errors_si(const Table& errors) {
  VectorXd x(24);
  for (int k = 0; k < 24; ++k) x[k] = errors[k] * unit_of(k);
  return x;
}

Table errors_as_printed(ConstVectorRef si) {
  Table table{};
  for (int k = 0; k < 24; ++k) table[k] = si[k] / unit_of(k);
  return table;
}

Chain with_errors(const Chain& nominal, const Table& errors, double factor) {
  const ParameterSet set = table2_parameters(nominal);
  return unpack(set, nominal, pack(set, nominal) + factor * errors_si(errors));
}

MatrixXd drawn_joints(const Chain& nominal, int poses, Rng rng) {
  constexpr double clearance = 350 * millimetre;
  MatrixXd joints(6, poses);
  for (int i = 0; i < poses; ++i) {
    Rng draw = rng.stream(i);
    Vec3 tool;
    do {
      for (int j = 0; j < 6; ++j) joints(j, i) = draw.uniform(nominal.joints[j].lower, nominal.joints[j].upper);
      tool = forward(nominal, joints.col(i)).position;
    } while (tool.z() <= 0.0 || tool.head<2>().norm() <= clearance);
  }
  return joints;
}

}  // namespace kinfer::paper2
