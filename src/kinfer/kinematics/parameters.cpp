// SPDX-License-Identifier: Apache-2.0
#include "kinfer/kinematics/parameters.hpp"

#include <algorithm>

#include "kinfer/base/expect.hpp"

namespace kinfer {
namespace {

std::span<const Field> frame_numbers() {
  return fields_of(NamedFrame{});
}

constexpr Field dh_fields[] = {Field::a, Field::alpha, Field::d, Field::theta, Field::beta};

double tolerance_of(const ParameterAddress& at, const Tolerances& t) {
  const Quantity quantity = quantity_of(at);
  if (quantity == Quantity::ratio) return t.gain;
  if (quantity == Quantity::compliance) return t.compliance;
  const bool is_length = quantity == Quantity::length;
  if (std::holds_alternative<FixtureNumber>(at)) return t.anchor;
  if (std::holds_alternative<TargetNumber>(at)) return t.tool_length;
  const auto* frame = std::get_if<FrameNumber>(&at);
  if (!frame) return is_length ? t.length : t.angle;
  if (frame->frame == SetupFrame::base) return is_length ? t.base_length : t.base_angle;
  return is_length ? t.tool_length : t.tool_angle;
}

void append(ParameterSet& set, const Chain& chain, const ParameterAddress& at, const Tolerances& tolerances) {
  set.parameters.push_back(parameter_at(chain, at, tolerance_of(at, tolerances)));
}

/// A parameter without a prior.
void append_unknown(ParameterSet& set, const Chain& chain, const ParameterAddress& at) {
  Parameter parameter = parameter_at(chain, at, std::numeric_limits<double>::infinity());
  parameter.scale = 1e-2;  // [m] or [rad]
  set.parameters.push_back(parameter);
}

std::vector<Field> fields_of(const Joint& joint) {
  std::vector<Field> fields;
  if (std::holds_alternative<UrdfLink>(joint.link)) {
    fields.assign(frame_numbers().begin(), frame_numbers().end());
  } else {
    fields.assign(std::begin(dh_fields), std::end(dh_fields));
  }
  if (joint.is_active && has_position(joint.type)) fields.push_back(Field::gain);
  if (rotates(joint.type)) fields.push_back(Field::compliance);
  return fields;
}

/// Joints on the path to the tip or to that of a further mounting, ascending.
std::vector<int> joints_on_tool_paths(const Chain& chain) {
  std::vector<int> joints = path_to(chain, chain.tip_joint());
  for (const RobotMounting& mounting : chain.mountings) {
    if (mounting.tip < 0) continue;
    const std::vector<int> path = path_to(chain, mounting.tip);
    joints.insert(joints.end(), path.begin(), path.end());
  }
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  return joints;
}

}  // namespace

Eigen::Index ParameterSet::free_count() const {
  return std::count_if(parameters.begin(), parameters.end(), [](const Parameter& p) { return p.free; });
}

const Parameter* ParameterSet::find(std::string_view name) const {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

std::vector<const Parameter*> ParameterSet::free() const {
  std::vector<const Parameter*> list;
  for (const Parameter& p : parameters) {
    if (p.free) list.push_back(&p);
  }
  return list;
}

ParameterSet all_parameters(const Chain& chain, const Tolerances& tolerances) {
  expect_well_formed(chain);
  ParameterSet set;
  for (const Field field : frame_numbers()) append(set, chain, FrameNumber{SetupFrame::base, field}, tolerances);
  for (const int j : joints_on_tool_paths(chain)) {
    for (const Field field : fields_of(chain.joints[j])) append(set, chain, JointNumber{j, field}, tolerances);
    for (int k = 0; k < static_cast<int>(chain.joints[j].couplings.size()); ++k)
      append(set, chain, JointNumber{j, Field::coupling, k}, tolerances);
  }
  for (const Field field : frame_numbers()) append(set, chain, FrameNumber{SetupFrame::tool, field}, tolerances);
  return set;
}

ParameterSet setup_parameters(const Chain& chain, const Tolerances& tolerances) {
  ParameterSet set;
  const auto xyz = {Field::x, Field::y, Field::z};
  for (int m = 0; m < static_cast<int>(chain.mountings.size()); ++m) {
    for (const Field field : frame_numbers())
      if (chain.mountings[m].base) append(set, chain, FrameNumber{SetupFrame::base, field, m}, tolerances);
    for (const Field field : frame_numbers()) append(set, chain, FrameNumber{SetupFrame::tool, field, m}, tolerances);
  }
  for (int i = 0; i < static_cast<int>(chain.targets.size()); ++i)
    for (const Field field : xyz) append(set, chain, TargetNumber{i, field}, tolerances);
  for_each_fixture_list(chain.fixtures, [&](const auto& row, const auto& list) {
    const FixtureKind kind = fixture_kind(row.kind);
    for (int i = 0; i < static_cast<int>(list.size()); ++i)
      for (const Field field : fields_of(list[i])) {
        const FixtureNumber at{kind, i, field};
        row.prior == FixturePrior::none ? append_unknown(set, chain, at) : append(set, chain, at, tolerances);
      }
  });
  return set;
}

Parameter parameter_at(const Chain& chain, const ParameterAddress& at, double prior_sd) {
  return {.name = name_of(chain, at),
          .quantity = quantity_of(at),
          .at = at,
          .nominal = value_at(chain, at),
          .scale = prior_sd,
          .prior_sd = prior_sd};
}

ParameterSet with_only_free(ParameterSet set, const std::vector<std::string>& names) {
  for (const std::string& name : names) KINFER_EXPECT(set.find(name), "no parameter is called {}", name);
  for (Parameter& p : set.parameters) p.free = std::find(names.begin(), names.end(), p.name) != names.end();
  set.prior_sqrt_information.resize(0, 0);
  return set;
}

MatrixXd prior_sqrt_information_of(const ParameterSet& set) {
  const std::vector<const Parameter*> free = set.free();
  const auto n = static_cast<Eigen::Index>(free.size());
  if (set.prior_sqrt_information.size() > 0) {
    KINFER_EXPECT(set.prior_sqrt_information.cols() == n, "a prior of {} parameters for {} free ones",
                  set.prior_sqrt_information.cols(), n);
    return set.prior_sqrt_information;
  }
  MatrixXd rows = MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k) rows(k, k) = 1.0 / free[k]->prior_sd;  // 0 where there is no prior
  return rows;
}

VectorXd nominal_of(const ParameterSet& set) {
  VectorXd nominal(set.free_count());
  Eigen::Index k = 0;
  for (const Parameter* p : set.free()) nominal[k++] = p->nominal;
  return nominal;
}

VectorXd pack(const ParameterSet& set, const Chain& chain) {
  VectorXd x(set.free_count());
  Eigen::Index i = 0;
  for (const Parameter& p : set.parameters) {
    if (p.free) x[i++] = value_at(chain, p.at);
  }
  return x;
}

Chain unpack(const ParameterSet& set, const Chain& nominal, ConstVectorRef x) {
  KINFER_EXPECT(x.size() == set.free_count(), "{} values for {} free parameters", x.size(), set.free_count());
  Chain chain = nominal;
  Eigen::Index i = 0;
  for (const Parameter& p : set.parameters) {
    if (p.free) set_value_at(chain, p.at, x[i++]);
  }
  return chain;
}

std::map<std::string, ParameterAddress> addresses_by_name(const Chain& chain) {
  std::map<std::string, ParameterAddress> addresses;
  for (const ParameterSet& set : {all_parameters(chain, {}), setup_parameters(chain, {})})
    for (const Parameter& parameter : set.parameters) addresses.emplace(parameter.name, parameter.at);
  for (const ParameterAddress& at : non_geometric_addresses(chain)) addresses.emplace(name_of(chain, at), at);
  return addresses;
}

}  // namespace kinfer
