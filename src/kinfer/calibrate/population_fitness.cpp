#include "kinfer/calibrate/population_fitness.hpp"

#include <algorithm>
#include <cmath>

#include "kinfer/base/expect.hpp"
#include "kinfer/kinematics/elementary.hpp"
#include "kinfer/kinematics/forward.hpp"

namespace kinfer {
namespace {

using elementary::Factor;
using elementary::Motion;

/// A constant transform, then a joint's turn about or shift along z of the frame reached. The last has no joint.
struct Segment {
  Pose constant;
  Motion motion = Motion::turn;
};

/// Folds a chain into segments: the offset of a joint's variable belongs to the constant before its motion.
class Folder {
 public:
  explicit Folder(std::vector<Segment>& segments) : segments_(segments) { segments_.assign(1, {}); }

  void operator()(const Mat3& rotation) { segments_.back().constant.rotation *= rotation; }
  void operator()(const Factor& factor) {
    if (factor.value != 0.0) elementary::apply(segments_.back().constant, factor.motion, factor.axis, factor.value);
    if (!factor.moves) return;
    KINFER_EXPECT(factor.axis == 2, "every convention moves about or along z");
    segments_.back().motion = factor.motion;
    segments_.emplace_back();
  }

 private:
  std::vector<Segment>& segments_;
};

/// How one joint moved at every point: cosine and sine of a turn, or the length of a shift and nothing.
struct Movements {
  std::vector<double> first, second;
};

/// One number per point, coordinate by coordinate, so that the compiler can take several points at once.
struct Points {
  std::vector<double> x, y, z;
  explicit Points(std::size_t n) : x(n), y(n), z(n) {}
};

/// p seen from before the constant transform.
void carry_inwards(Points& p, const Pose& constant) {
  const Mat3& r = constant.rotation;
  const double r00 = r(0, 0), r01 = r(0, 1), r02 = r(0, 2), r10 = r(1, 0), r11 = r(1, 1), r12 = r(1, 2), r20 = r(2, 0),
               r21 = r(2, 1), r22 = r(2, 2);
  const double tx = constant.position.x(), ty = constant.position.y(), tz = constant.position.z();
  double *px = p.x.data(), *py = p.y.data(), *pz = p.z.data();
  const std::size_t n = p.x.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double x = px[i], y = py[i], z = pz[i];
    px[i] = r00 * x + r01 * y + r02 * z + tx;
    py[i] = r10 * x + r11 * y + r12 * z + ty;
    pz[i] = r20 * x + r21 * y + r22 * z + tz;
  }
}

/// p seen from before the joint's motion.
void carry_inwards(Points& p, Motion motion, const Movements& moved) {
  double *px = p.x.data(), *py = p.y.data(), *pz = p.z.data();
  const double *first = moved.first.data(), *second = moved.second.data();
  const std::size_t n = p.x.size();
  if (motion == Motion::shift) {
    for (std::size_t i = 0; i < n; ++i) pz[i] += first[i];
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double x = px[i], y = py[i];
    px[i] = first[i] * x - second[i] * y;
    py[i] = second[i] * x + first[i] * y;
  }
}

bool bends(const Chain& chain, const ParameterSet& set) {
  const auto free = set.free();
  return std::any_of(chain.joints.begin(), chain.joints.end(), [](const Joint& j) { return j.compliance != 0.0; }) ||
         std::any_of(free.begin(), free.end(),
                     [](const Parameter* p) { return p->at.field == Field::compliance || p->at.field == Field::gain; });
}

}  // namespace

struct PopulationFitness::Plan {
  Chain nominal;
  ParameterSet set;
  std::vector<Address> addresses;  // of the free parameters
  std::vector<int> path;           // joints from the base to the tip
  std::vector<PointMeasurement> points;
  MatrixXd joints;
  std::vector<double> payload;
  std::vector<Movements> moved;  // of each joint of the path that moves, at every point
  bool plain = true;             // false: the readings' effect depends on the candidate, all is computed anew

  std::vector<Vec3> points_on_tool() const {  // the tool point, then the further targets
    std::vector<Vec3> list{Vec3::Zero()};
    for (const Target& target : nominal.targets) list.push_back(target.xyz);
    return list;
  }

  void fold(const Chain& chain, std::vector<Segment>& segments) const {
    Folder folder(segments);
    elementary::for_each_factor(chain.base, folder);
    for (const int j : path) elementary::for_each_factor(chain.joints[j], folder);
    elementary::for_each_factor(chain.tool, folder);
  }

  double plain_sum(const std::vector<Segment>& segments, const std::vector<Vec3>& on_tool, Points& p) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3& start = on_tool[points[i].target + 1];
      p.x[i] = start.x(), p.y[i] = start.y(), p.z[i] = start.z();
    }
    carry_inwards(p, segments.back().constant);
    for (std::size_t k = segments.size() - 1; k-- > 0;) {
      carry_inwards(p, segments[k].motion, moved[k]);
      carry_inwards(p, segments[k].constant);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
      sum += (points[i].position - Vec3(p.x[i], p.y[i], p.z[i])).squaredNorm();
    return sum;
  }

  double slow_sum(const Chain& chain, const std::vector<Vec3>& on_tool) const {
    const PoseEvaluator evaluator(chain, {});
    double sum = 0.0;
    for (const PointMeasurement& point : points) {
      const Load load{.payload = payload.empty() ? 0.0 : payload[point.row]};
      sum += (point.position - evaluator.pose(joints.col(point.row), load) * on_tool[point.target + 1]).squaredNorm();
    }
    return sum;
  }
};

PopulationFitness::PopulationFitness(const Chain& nominal, const ParameterSet& set, const PoseSet& data) {
  auto plan = std::make_unique<Plan>();
  plan->nominal = nominal;
  plan->set = set;
  plan->points = data.points;
  plan->joints = data.joints;
  plan->payload = data.payload;
  plan->plain = !bends(nominal, set);
  for (const Parameter* p : set.free()) plan->addresses.push_back(p->at);
  for (const int j : path_to(nominal, nominal.tip_joint())) {
    plan->path.push_back(j);
    if (nominal.joints[j].type == JointType::fixed) continue;
    Movements& movements = plan->moved.emplace_back();
    const bool turns = nominal.joints[j].type == JointType::revolute;
    for (const PointMeasurement& point : data.points) {
      const double by = moved_by_readings(nominal, data.joints.col(point.row))[j];
      movements.first.push_back(turns ? std::cos(by) : by);
      movements.second.push_back(turns ? std::sin(by) : 0.0);
    }
  }
  plan_ = std::move(plan);
}

PopulationFitness::~PopulationFitness() = default;
PopulationFitness::PopulationFitness(PopulationFitness&&) noexcept = default;

void PopulationFitness::sums(ConstMatrixRef x, std::span<double> sum) const {
  KINFER_EXPECT(x.rows() == static_cast<Eigen::Index>(plan_->addresses.size()), "{} values for {} free parameters",
                x.rows(), plan_->addresses.size());
  Chain chain = plan_->nominal;
  const std::vector<Vec3> on_tool = plan_->points_on_tool();
  std::vector<Segment> segments;
  Points points(plan_->points.size());
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    for (Eigen::Index k = 0; k < x.rows(); ++k) set_value_at(chain, plan_->addresses[k], x(k, i));
    if (plan_->plain) {
      plan_->fold(chain, segments);
      sum[i] = plan_->plain_sum(segments, on_tool, points);
    } else {
      sum[i] = plan_->slow_sum(chain, on_tool);
    }
  }
}

std::size_t PopulationFitness::points() const {
  return plan_->points.size();
}

}  // namespace kinfer
