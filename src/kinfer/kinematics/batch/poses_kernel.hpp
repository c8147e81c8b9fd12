// SPDX-License-Identifier: Apache-2.0
// Walks a chain from the world to the tool, one row per lane. Included by the kernel files only.
#pragma once

#include "kinfer/base/pack_kernel.hpp"
#include "kinfer/kinematics/batch/pose_job.hpp"

namespace kinfer::batch {
namespace {  // one copy per kernel file, compiled for its instruction set

template <class V>
struct Vector {
  V x, y, z;
};
template <class V>
inline Vector<V> cross(const Vector<V>& a, const Vector<V>& b) {
  return {mul_sub(a.y, b.z, a.z * b.y), mul_sub(a.z, b.x, a.x * b.z), mul_sub(a.x, b.y, a.y * b.x)};
}
template <class V>
inline Vector<V> operator-(const Vector<V>& a, const Vector<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class V>
inline Vector<V> scaled(V by, const Vector<V>& a) {
  return {by * a.x, by * a.y, by * a.z};
}
/// a + by · b
template <class V>
inline Vector<V> plus(const Vector<V>& a, V by, const Vector<V>& b) {
  return {mul_add(by, b.x, a.x), mul_add(by, b.y, a.y), mul_add(by, b.z, a.z)};
}
template <class V>
inline V dot(const Vector<V>& a, const Vector<V>& b) {
  return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
template <class V>
inline Vector<V> broadcast_vector(const double* v) {
  return {broadcast<V>(v[0]), broadcast<V>(v[1]), broadcast<V>(v[2])};
}
template <class V>
inline void store_vector(double* to, const Vector<V>& v) {
  constexpr int lanes = Traits<V>::lanes;
  store(to, v.x), store(to + lanes, v.y), store(to + 2 * lanes, v.z);
}
template <class V>
inline Vector<V> load_vector(const double* from) {
  constexpr int lanes = Traits<V>::lanes;
  return {load<V>(from), load<V>(from + lanes), load<V>(from + 2 * lanes)};
}

/// A pose: the columns of its rotation, and its position.
template <class V>
struct FramePack {
  Vector<V> axis[3];
  Vector<V> position;
};

template <class V>
inline FramePack<V> identity_frame() {
  const V zero = broadcast<V>(0.0), one = broadcast<V>(1.0);
  return {{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}, {zero, zero, zero}};
}

template <class V>
inline void rotate(FramePack<V>& at, int axis, V c, V s) {
  Vector<V>&u = at.axis[axis == 2 ? 0 : axis + 1], &v = at.axis[axis == 0 ? 2 : axis - 1];
  const Vector<V> first = u, second = v;
  u = {mul_add(c, first.x, s * second.x), mul_add(c, first.y, s * second.y), mul_add(c, first.z, s * second.z)};
  v = {mul_sub(c, second.x, s * first.x), mul_sub(c, second.y, s * first.y), mul_sub(c, second.z, s * first.z)};
}

template <class V>
inline void translate(FramePack<V>& at, int axis, V length) {
  at.position = plus(at.position, length, at.axis[axis]);
}

/// Σ axis_k · v_k
template <class V>
inline Vector<V> turned(const FramePack<V>& at, V x, V y, V z) {
  const Vector<V>&a = at.axis[0], &b = at.axis[1], &c = at.axis[2];
  return {mul_add(x, a.x, mul_add(y, b.x, z * c.x)), mul_add(x, a.y, mul_add(y, b.y, z * c.y)),
          mul_add(x, a.z, mul_add(y, b.z, z * c.z))};
}

/// By a constant transform of 3 x 4, row by row.
template <class V>
inline void transform(FramePack<V>& at, const double* by) {
  const auto number = [by](int k) { return broadcast<V>(by[k]); };
  const Vector<V> shift = turned(at, number(3), number(7), number(11));
  const Vector<V> axes[3] = {turned(at, number(0), number(4), number(8)), turned(at, number(1), number(5), number(9)),
                             turned(at, number(2), number(6), number(10))};
  at.position = plus(at.position, broadcast<V>(1.0), shift);
  for (int k = 0; k < 3; ++k) at.axis[k] = axes[k];
}

template <class V>
inline V number_at(const double* item, int number) {
  return load<V>(item + number * Traits<V>::lanes);
}

template <class V>
inline V sum_of_terms(const DisplacementTerm* terms, int first, int end, const double* item) {
  V sum = broadcast<V>(0.0);
  for (int k = first; k < end; ++k)
    sum = mul_add(broadcast<V>(terms[k].factor), number_at<V>(item, terms[k].number), sum);
  return sum;
}

/// Σ sine_k sin(k q) + cosine_k cos(k q): four orders at a time, each four the ones before turned on by 4 q.
template <class V>
inline V sum_of_harmonics(const JointDisplacement& joint, const double* item) {
  constexpr int at_once = 4;
  const SinCos<V> first = sin_cos(number_at<V>(item, joint.angle));
  SinCos<V> wave[at_once + 1] = {{broadcast<V>(0.0), broadcast<V>(1.0)}};
  for (int k = 0; k < at_once; ++k) {
    wave[k + 1].sin = mul_add(wave[k].sin, first.cos, wave[k].cos * first.sin);
    wave[k + 1].cos = mul_sub(wave[k].cos, first.cos, wave[k].sin * first.sin);
  }
  const SinCos<V> turn = wave[at_once];
  V sums[at_once];
  for (V& sum : sums) sum = broadcast<V>(0.0);
  int order = 0;
  for (; order + at_once <= joint.harmonics; order += at_once) {
    for (int k = 0; k < at_once; ++k) {
      sums[k] = mul_add(broadcast<V>(joint.sines[order + k]), wave[k].sin, sums[k]);
      sums[k] = mul_add(broadcast<V>(joint.cosines[order + k]), wave[k].cos, sums[k]);
      const V sine = wave[k].sin;
      wave[k].sin = mul_add(sine, turn.cos, wave[k].cos * turn.sin);
      wave[k].cos = mul_sub(wave[k].cos, turn.cos, sine * turn.sin);
    }
  }
  for (int k = 0; order + k < joint.harmonics; ++k) {
    sums[k] = mul_add(broadcast<V>(joint.sines[order + k]), wave[k].sin, sums[k]);
    sums[k] = mul_add(broadcast<V>(joint.cosines[order + k]), wave[k].cos, sums[k]);
  }
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

template <class V>
inline V displacement_of(const PoseJob& job, int index, const double* item) {
  const JointDisplacement& joint = job.joints[index];
  const V sum = sum_of_terms<V>(job.terms, joint.first, joint.end, item);
  return joint.harmonics > 0 ? sum + sum_of_harmonics<V>(joint, item) : sum;
}

template <class V>
inline void write_waves(const PoseJob& job, double* item) {
  constexpr int lanes = Traits<V>::lanes;
  for (int k = 0; k < job.wave_count; ++k) {
    const Wave& wave = job.waves[k];
    const SinCos<V> at = sin_cos(broadcast<V>(wave.order) * number_at<V>(item, wave.angle));
    store(item + wave.slot * lanes, at.sin), store(item + (wave.slot + 1) * lanes, at.cos);
  }
}

/// What the workspace holds of each joint of the undeflected chain: packs of its frame, of its axis and a point of it,
/// and of first moment about the world's origin and mass of all that it carries.
template <class V>
class CarriedBy {
 public:
  CarriedBy(double* workspace, int joint) : memory_(workspace + joint * 22 * lanes) {}

  FramePack<V> frame() const { return {{vector(0), vector(3), vector(6)}, vector(9)}; }
  Vector<V> axis() const { return vector(12); }
  Vector<V> point() const { return vector(15); }
  Vector<V> moment() const { return vector(18); }
  V mass() const { return load<V>(memory_ + 21 * lanes); }

  void place(const FramePack<V>& frame) {
    for (int k = 0; k < 3; ++k) set(3 * k, frame.axis[k]);
    set(9, frame.position);
    for (int k = 18; k < 22; ++k) store(memory_ + k * lanes, broadcast<V>(0.0));
  }
  void set_axis(const Vector<V>& axis, const Vector<V>& point) { set(12, axis), set(15, point); }
  void add(const Vector<V>& moment_of, V mass_of) {
    set(18, plus(moment(), broadcast<V>(1.0), moment_of));
    store(memory_ + 21 * lanes, mass() + mass_of);
  }

 private:
  static constexpr int lanes = Traits<V>::lanes;
  Vector<V> vector(int first) const { return load_vector<V>(memory_ + first * lanes); }
  void set(int first, const Vector<V>& v) { store_vector(memory_ + first * lanes, v); }

  double* memory_;
};

template <class V>
inline void place_loaded_joint(const PoseJob& job, int index, const double* item) {
  const LoadedJoint& joint = job.gravity.joints[index];
  CarriedBy<V> here(job.workspace, index);
  FramePack<V> frame = identity_frame<V>();
  if (joint.parent >= 0)
    frame = CarriedBy<V>(job.workspace, joint.parent).frame();
  else
    transform(frame, job.gravity.base);
  transform(frame, joint.before);
  here.set_axis(frame.axis[joint.axis], frame.position);
  if (joint.move != LoadedJoint::Move::none) {
    const V by = broadcast<V>(joint.offset) + sum_of_terms<V>(job.terms, joint.first, joint.end, item);
    if (joint.move == LoadedJoint::Move::rotation) {
      const SinCos<V> turn = sin_cos(by);
      rotate(frame, joint.axis, turn.cos, turn.sin);
    } else {
      translate(frame, joint.axis, by);
    }
    transform(frame, joint.after);
  }
  here.place(frame);
}

template <class V>
inline void add_mass(const PoseJob& job, const CarriedMass& carried, const double* item) {
  const V mass = carried.number < 0 ? broadcast<V>(carried.mass) : number_at<V>(item, carried.number);
  CarriedBy<V> by(job.workspace, carried.joint);
  const FramePack<V> frame = by.frame();
  const Vector<V> offset =
      turned(frame, broadcast<V>(carried.at[0]), broadcast<V>(carried.at[1]), broadcast<V>(carried.at[2]));
  by.add(scaled(mass, plus(frame.position, broadcast<V>(1.0), offset)), mass);
}

/// The torque of gravity about each joint's axis, of the chain as it is without deflection: written to the item.
template <class V>
inline void write_gravity_torques(const PoseJob& job, double* item) {
  const GravityPlan& plan = job.gravity;
  for (int j = 0; j < plan.joint_count; ++j) place_loaded_joint<V>(job, j, item);
  for (int k = 0; k < plan.mass_count; ++k) add_mass<V>(job, plan.masses[k], item);
  for (int j = plan.joint_count - 1; j >= 0; --j) {
    const LoadedJoint& joint = plan.joints[j];
    const CarriedBy<V> here(job.workspace, j);
    V torque = broadcast<V>(0.0);
    if (joint.move == LoadedJoint::Move::rotation) {
      const Vector<V> lever = plus(here.moment(), -here.mass(), here.point());
      torque = dot(here.axis(), cross(lever, broadcast_vector<V>(plan.gravity)));
    }
    store(item + (plan.torques + j) * Traits<V>::lanes, torque);
    if (joint.parent >= 0) CarriedBy<V>(job.workspace, joint.parent).add(here.moment(), here.mass());
  }
}

/// Until the tool position is known, a rotational column holds a point of its axis before the axis.
template <class V>
inline void record(const PoseStep& step, const FramePack<V>& at, const double* item, double* twists) {
  constexpr int lanes = Traits<V>::lanes;
  double* column = twists + step.index * 6 * lanes;
  Vector<V> axis = at.axis[step.axis];
  if (step.scale >= 0) axis = scaled(number_at<V>(item, step.scale), axis);
  const V zero = broadcast<V>(0.0);
  const bool rotates = step.kind == PoseStep::Kind::record_rotation;
  store_vector(column, rotates ? at.position : axis);
  store_vector(column + 3 * lanes, rotates ? axis : Vector<V>{zero, zero, zero});
}

/// Columns of joints scale with the robot's lengths, those of the tool move with the flange.
template <class V>
inline void stretch_columns(const PoseJob& job, V rise, const Vector<V>& flange, double* twists) {
  constexpr int lanes = Traits<V>::lanes;
  const V by = broadcast<V>(job.expansion) * rise;
  const Vector<V> base = broadcast_vector<V>(job.base), arm = flange - base;
  for (int c = 0; c < job.column_count; ++c) {
    double* column = twists + c * 6 * lanes;
    const Vector<V> top = load_vector<V>(column);
    const PoseColumn& is = job.columns[c];
    if (is.stretch == Stretch::joint) store_vector(column, plus(top, by, is.rotates ? top - base : top));
    if (is.stretch == Stretch::tool && is.rotates) store_vector(column, plus(top, by, arm));
    if (is.stretch == Stretch::is_the_expansion) store_vector(column, scaled(rise, arm));
  }
}

template <class V>
inline void place_columns_at(const Vector<V>& tool, const PoseJob& job, double* twists) {
  constexpr int lanes = Traits<V>::lanes;
  for (int c = 0; c < job.column_count; ++c) {
    if (!job.columns[c].rotates) continue;
    double* column = twists + c * 6 * lanes;
    const Vector<V> axis = load_vector<V>(column + 3 * lanes);
    store_vector(column, cross(axis, tool - load_vector<V>(column)));
  }
}

template <class V>
inline void walk(const PoseJob& job, const double* item, double* pose, double* twists) {
  constexpr int lanes = Traits<V>::lanes;
  FramePack<V> at = identity_frame<V>();
  Vector<V> flange = at.position;
  for (int k = 0; k < job.step_count; ++k) {
    const PoseStep& step = job.steps[k];
    switch (step.kind) {
      case PoseStep::Kind::rotate:
        rotate(at, step.axis, broadcast<V>(step.a), broadcast<V>(step.b));
        break;
      case PoseStep::Kind::translate:
        translate(at, step.axis, broadcast<V>(step.a));
        break;
      case PoseStep::Kind::transform:
        transform(at, job.constants + 12 * step.index);
        break;
      case PoseStep::Kind::revolute_joint: {
        const SinCos<V> turn = sin_cos(broadcast<V>(step.a) + displacement_of<V>(job, step.index, item));
        rotate(at, step.axis, turn.cos, turn.sin);
        break;
      }
      case PoseStep::Kind::prismatic_joint:
        translate(at, step.axis, broadcast<V>(step.a) + displacement_of<V>(job, step.index, item));
        break;
      case PoseStep::Kind::record_rotation:
      case PoseStep::Kind::record_translation:
        record(step, at, item, twists);
        break;
      case PoseStep::Kind::flange:
        flange = at.position;
        break;
    }
  }
  if (job.rise >= 0) {
    const V rise = number_at<V>(item, job.rise);
    if (twists) stretch_columns(job, rise, flange, twists);
    at.position = plus(at.position, broadcast<V>(job.expansion) * rise, flange - broadcast_vector<V>(job.base));
  }
  if (twists) place_columns_at(at.position, job, twists);
  for (int k = 0; k < 3; ++k) store_vector(pose + 3 * k * lanes, at.axis[k]);
  store_vector(pose + 9 * lanes, at.position);
}

template <class V>
void poses(const PoseJob& job) {
  constexpr int lanes = Traits<V>::lanes;
  for (int block = 0; block < job.blocks; ++block) {
    double* item = job.items + static_cast<std::ptrdiff_t>(block) * job.stride * lanes;
    double* twists =
        job.twists ? job.twists + static_cast<std::ptrdiff_t>(block) * 6 * job.column_count * lanes : nullptr;
    if (twists)
      for (int k = 0; k < 6 * job.column_count; ++k)
        if (!job.columns[k / 6].acts) store(twists + k * lanes, broadcast<V>(0.0));
    write_waves<V>(job, item);
    if (job.gravity.joint_count > 0) write_gravity_torques<V>(job, item);
    walk<V>(job, item, job.poses + static_cast<std::ptrdiff_t>(block) * 12 * lanes, twists);
  }
}

}  // namespace
}  // namespace kinfer::batch
