// Residuals, their derivative and the normal equations of many points at one candidate: lanes are points. Included by
// the kernel files only.
//
// A point is carried from the tool inwards and its place before each screw is noted. Then a frame is carried outwards,
// rotation only: what a turn about axis e of that frame does to the point is R (e × place), what a shift does is R e
// (the columns of the geometric Jacobian; Whitney 1972). The frame starts with the weights, so that columns come out
// weighted. The normal equations grow chunk by chunk: no Jacobian need be kept.
#pragma once

#include "kinfer/kinematics/batch_points_kernel.hpp"
#include "kinfer/kinematics/batch_sines_kernel.hpp"
#include "kinfer/linalg/gram_kernel.hpp"

namespace kinfer::batch {
namespace {  // each kernel file has its own, compiled for its processor

/// What a candidate makes of a screw: cosine, sine, length, change of the gain.
inline constexpr int numbers_of_screw = 4;
/// What is noted of a point at a screw: its place across the axis; cosine and sine where they are the point's own.
inline constexpr int notes_of_screw = 4;

inline void fold_screws(const JacobianJob& job, const Sines& at, double* to) {
  for (int k = 0; k < job.screw_count; ++k, to += numbers_of_screw) {
    const Screw& screw = job.screws[k];
    to[0] = at.cos(screw.turn), to[1] = at.sin(screw.turn);
    to[2] = at.value(screw.shift);
    to[3] = screw.gain.parameter < 0 ? 0.0 : at.value(screw.gain) - screw.gain.constant;
  }
}

template <int axis, class V, int n>
inline V (&part(Points<V, n>& p))[n] {
  if constexpr (axis == 0) return p.x;
  if constexpr (axis == 1) return p.y;
  if constexpr (axis == 2) return p.z;
}

/// n blocks of points in flight.
template <class V, int n>
class Walk {
 public:
  static constexpr int lanes = Traits<V>::lanes;

  /// `notes`: notes_of_screw · n packs a screw. `to`: row 0 of column 0 of the first block; columns are `apart` numbers
  /// apart, blocks 3 packs.
  Walk(const JacobianJob& job, int block, const double* numbers, double* notes, double* to, std::ptrdiff_t apart)
      : job_(job), block_(block), numbers_(numbers), notes_(notes), to_(to), apart_(apart) {}

  /// Writes the weighted residuals, which are `between` numbers from block to block, and adds their squares to `sum`.
  void inwards(const double* on_tool, double* residuals, V& sum) const {
    Points<V, n> p;
    fill(p.x, on_tool[0]), fill(p.y, on_tool[1]), fill(p.z, on_tool[2]);
    for (int k = job_.screw_count - 1; k >= 0; --k) {
      const Screw& screw = job_.screws[k];
      const double* numbers = numbers_ + numbers_of_screw * k;
      if (screw.is_rotation) {
        turn_constantly(screw.rotation, p);
      } else if (screw.move != Move::none) {
        move_inwards(screw, numbers, note_at(k), p);
      } else if (screw.axis == 0) {
        go_inwards<0>(numbers, note_at(k), p);
      } else if (screw.axis == 1) {
        go_inwards<1>(numbers, note_at(k), p);
      } else {
        go_inwards<2>(numbers, note_at(k), p);
      }
    }
    const int measured = job_.stride - 3;
    for (int u = 0; u < n; ++u) {
      const V x = weight(u, 0) * (datum(u, measured) - p.x[u]), y = weight(u, 1) * (datum(u, measured + 1) - p.y[u]),
              z = weight(u, 2) * (datum(u, measured + 2) - p.z[u]);
      double* at = residuals + 3 * lanes * u;
      store(at, x), store(at + lanes, y), store(at + 2 * lanes, z);
      sum = mul_add(x, x, mul_add(y, y, mul_add(z, z, sum)));
    }
  }

  /// Writes the columns of d residual.
  void outwards() const {
    Points<V, n> x, y, z;  // the frame's axes, seen in the world and weighted
    for (int u = 0; u < n; ++u) {
      const V zero = broadcast<V>(0.0);
      x.x[u] = -weight(u, 0), x.y[u] = zero, x.z[u] = zero;
      y.x[u] = zero, y.y[u] = -weight(u, 1), y.z[u] = zero;
      z.x[u] = zero, z.y[u] = zero, z.z[u] = -weight(u, 2);
    }
    for (int k = 0; k < job_.screw_count; ++k) {
      const Screw& screw = job_.screws[k];
      const double* numbers = numbers_ + numbers_of_screw * k;
      if (screw.is_rotation) {
        rotate(screw.rotation, x, y, z);
      } else if (screw.axis == 0) {
        go_outwards(screw, numbers, note_at(k), x, y, z);
      } else if (screw.axis == 1) {
        go_outwards(screw, numbers, note_at(k), y, z, x);
      } else if (screw.move == Move::none) {
        go_outwards(screw, numbers, note_at(k), z, x, y);
      } else {
        move_outwards(screw, numbers, note_at(k), z, x, y);
      }
    }
  }

 private:
  static void fill(V (&to)[n], double value) {
    for (int u = 0; u < n; ++u) to[u] = broadcast<V>(value);
  }
  V datum(int u, int slot) const {
    return load<V>(job_.items + (static_cast<std::ptrdiff_t>(block_ + u) * job_.stride + slot) * lanes);
  }
  V weight(int u, int row) const {
    return load<V>(job_.weights + (static_cast<std::ptrdiff_t>(block_ + u) * 3 + row) * lanes);
  }
  double* note_at(int k) const { return notes_ + static_cast<std::ptrdiff_t>(notes_of_screw * n * lanes) * k; }
  static double* noted(double* note, int i, int u) { return note + (i * n + u) * lanes; }

  static void turn_constantly(const double* by, Points<V, n>& p) {
    Points<V, n> q = p;
    const auto row = [&](int i, int u) {
      return mul_add(broadcast<V>(by[i]), p.x[u],
                     mul_add(broadcast<V>(by[i + 1]), p.y[u], broadcast<V>(by[i + 2]) * p.z[u]));
    };
    for (int u = 0; u < n; ++u) q.x[u] = row(0, u), q.y[u] = row(3, u), q.z[u] = row(6, u);
    p = q;
  }

  /// p seen from before a turn; its place across the axis is noted.
  template <int axis>
  static void turn_inwards(const V (&c)[n], const V (&s)[n], double* note, Points<V, n>& p) {
    V(&first)[n] = part<(axis + 1) % 3>(p), (&second)[n] = part<(axis + 2) % 3>(p);
    for (int u = 0; u < n; ++u) {
      const V a = first[u], b = second[u];
      first[u] = mul_sub(c[u], a, s[u] * b);
      second[u] = mul_add(s[u], a, c[u] * b);
      store(noted(note, 0, u), first[u]), store(noted(note, 1, u), second[u]);
    }
  }

  template <int axis>
  static void go_inwards(const double* numbers, double* note, Points<V, n>& p) {
    V c[n], s[n];
    fill(c, numbers[0]), fill(s, numbers[1]);
    turn_inwards<axis>(c, s, note, p);
    for (int u = 0; u < n; ++u) part<axis>(p)[u] += broadcast<V>(numbers[2]);
  }

  void move_inwards(const Screw& screw, const double* numbers, double* note, Points<V, n>& p) const {
    V c[n], s[n];
    fill(c, numbers[0]), fill(s, numbers[1]);
    for (int u = 0; u < n; ++u) {
      V first = datum(u, screw.slot);
      p.z[u] += broadcast<V>(numbers[2]);
      if (screw.move == Move::shift_by_gain) first = mul_add(broadcast<V>(numbers[3]), datum(u, screw.slot + 2), first);
      if (screw.move == Move::shift || screw.move == Move::shift_by_gain) {
        p.z[u] += first;
        continue;
      }
      turn_by(c[u], s[u], first, datum(u, screw.slot + 1));
      if (screw.move != Move::turn_by_gain) continue;
      const SinCos<V> more = sin_cos(broadcast<V>(numbers[3]) * datum(u, screw.slot + 2));
      turn_by(c[u], s[u], more.cos, more.sin);
    }
    for (int u = 0; u < n; ++u) store(noted(note, 2, u), c[u]), store(noted(note, 3, u), s[u]);
    turn_inwards<2>(c, s, note, p);
  }

  /// The sum of two angles.
  static void turn_by(V& c, V& s, V by_c, V by_s) {
    const V was = c;
    c = mul_sub(was, by_c, s * by_s);
    s = mul_add(was, by_s, s * by_c);
  }

  void put(int parameter, int u, V x, V y, V z) const {
    double* at = to_ + parameter * apart_ + 3 * lanes * u;
    store(at, x), store(at + lanes, y), store(at + 2 * lanes, z);
  }

  /// first × second = axis.
  void write_columns(const Screw& screw, double* note, const Points<V, n>& axis, const Points<V, n>& first,
                     const Points<V, n>& second) const {
    if (screw.turn.parameter >= 0)
      for (int u = 0; u < n; ++u) {
        const V a = load<V>(noted(note, 0, u)), b = load<V>(noted(note, 1, u));
        put(screw.turn.parameter, u, mul_sub(second.x[u], a, first.x[u] * b), mul_sub(second.y[u], a, first.y[u] * b),
            mul_sub(second.z[u], a, first.z[u] * b));
      }
    if (screw.shift.parameter >= 0)
      for (int u = 0; u < n; ++u) put(screw.shift.parameter, u, axis.x[u], axis.y[u], axis.z[u]);
  }

  static void turn_outwards(const V (&c)[n], const V (&s)[n], Points<V, n>& first, Points<V, n>& second) {
    const auto turn = [&](V(&a)[n], V(&b)[n]) {
      for (int u = 0; u < n; ++u) {
        const V was = a[u];
        a[u] = mul_add(c[u], was, s[u] * b[u]);
        b[u] = mul_sub(c[u], b[u], s[u] * was);
      }
    };
    turn(first.x, second.x), turn(first.y, second.y), turn(first.z, second.z);
  }

  void go_outwards(const Screw& screw, const double* numbers, double* note, Points<V, n>& axis, Points<V, n>& first,
                   Points<V, n>& second) const {
    write_columns(screw, note, axis, first, second);
    V c[n], s[n];
    fill(c, numbers[0]), fill(s, numbers[1]);
    turn_outwards(c, s, first, second);
  }

  void move_outwards(const Screw& screw, const double*, double* note, Points<V, n>& axis, Points<V, n>& first,
                     Points<V, n>& second) const {
    write_columns(screw, note, axis, first, second);
    if (screw.gain.parameter >= 0) write_gain(screw, note, axis, first, second);
    V c[n], s[n];
    for (int u = 0; u < n; ++u) c[u] = load<V>(noted(note, 2, u)), s[u] = load<V>(noted(note, 3, u));
    turn_outwards(c, s, first, second);
  }

  void write_gain(const Screw& screw, double* note, const Points<V, n>& axis, const Points<V, n>& first,
                  const Points<V, n>& second) const {
    for (int u = 0; u < n; ++u) {
      const V reading = datum(u, screw.slot + 2);
      if (screw.move == Move::shift_by_gain) {
        put(screw.gain.parameter, u, reading * axis.x[u], reading * axis.y[u], reading * axis.z[u]);
        continue;
      }
      const V a = reading * load<V>(noted(note, 0, u)), b = reading * load<V>(noted(note, 1, u));
      put(screw.gain.parameter, u, mul_sub(second.x[u], a, first.x[u] * b), mul_sub(second.y[u], a, first.y[u] * b),
          mul_sub(second.z[u], a, first.z[u] * b));
    }
  }

  static void rotate(const double* by, Points<V, n>& x, Points<V, n>& y, Points<V, n>& z) {
    const auto turn = [by](V(&a)[n], V(&b)[n], V(&c)[n]) {
      for (int u = 0; u < n; ++u) {
        const V was[3] = {a[u], b[u], c[u]};
        const auto column = [&](int i) {
          return mul_add(was[0], broadcast<V>(by[i]),
                         mul_add(was[1], broadcast<V>(by[3 + i]), was[2] * broadcast<V>(by[6 + i])));
        };
        a[u] = column(0), b[u] = column(1), c[u] = column(2);
      }
    };
    turn(x.x, y.x, z.x), turn(x.y, y.y, z.y), turn(x.z, y.z, z.z);
  }

  const JacobianJob& job_;
  int block_;
  const double* numbers_;
  double *notes_, *to_;
  std::ptrdiff_t apart_;
};

template <class V>
class JacobianKernel {
 public:
  static constexpr int lanes = Traits<V>::lanes, in_flight = blocks_in_flight;

  explicit JacobianKernel(const JacobianJob& job)
      : job_(job),
        numbers_(job.workspace),
        notes_(numbers_ + round_up(numbers_of_screw * job.screw_count, lanes)),
        chunk_(notes_ + notes_of_screw * in_flight * lanes * job.screw_count),
        gram_(job.columns, chunks_of(job.blocks), chunk_ + padded_columns(job.columns) * apart),
        sum_(broadcast<V>(0.0)) {
    fold_screws(job, Sines::of<V>(job.at, chunk_), numbers_);  // the chunk is still free
    for (int i = 0; i < job.idle_count; ++i) clear(job.idle[i]);
    if (!job.jacobian)
      for (int k = job.columns + 1; k < padded_columns(job.columns); ++k) clear(k);
  }

  /// Returns the sum of the squared residuals.
  double run() {
    for (int g = 0; g < job_.group_count; ++g) {
      const Group& group = job_.groups[g];
      int block = group.begin;
      for (; block + in_flight <= group.end; block += in_flight) walk<in_flight>(block, group.on_tool);
      for (; block < group.end; ++block) walk<1>(block, group.on_tool);
    }
    if (!job_.jacobian) gram_.finish(chunk_, apart, 3 * in_chunk_, job_.matrix, job_.gradient);
    double sum = 0.0;
    for (int lane = 0; lane < lanes; ++lane) sum += sum_[lane];
    return sum;
  }

 private:
  static constexpr int apart = 3 * blocks_a_chunk * lanes;

  /// A column that nothing writes.
  void clear(int column) const {
    const std::ptrdiff_t numbers = job_.jacobian ? static_cast<std::ptrdiff_t>(job_.blocks) * 3 * lanes : apart;
    double* to = (job_.jacobian ? job_.jacobian : chunk_) + column * numbers;
    for (std::ptrdiff_t i = 0; i < numbers; ++i) to[i] = 0.0;
  }

  template <int n>
  void walk(int block, const double* on_tool) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(block) * 3 * lanes;
    if (job_.jacobian) {
      const Walk<V, n> walk(job_, block, numbers_, notes_, job_.jacobian + at,
                            static_cast<std::ptrdiff_t>(job_.blocks) * 3 * lanes);
      walk.inwards(on_tool, job_.residuals + at, sum_);
      walk.outwards();
      return;
    }
    if (in_chunk_ + n > blocks_a_chunk) add_chunk();
    double* to = chunk_ + in_chunk_ * 3 * lanes;
    const Walk<V, n> walk(job_, block, numbers_, notes_, to, apart);
    walk.inwards(on_tool, to + job_.columns * apart, sum_);
    walk.outwards();
    in_chunk_ += n;
  }

  void add_chunk() {
    gram_.add(chunk_, apart, 3 * in_chunk_);
    in_chunk_ = 0;
  }

  const JacobianJob& job_;
  double *numbers_, *notes_, *chunk_;
  Gram<V> gram_;
  V sum_;
  int in_chunk_ = 0;
};

template <class V>
double jacobian(const JacobianJob& job) {
  return JacobianKernel<V>(job).run();
}

}  // namespace
}  // namespace kinfer::batch
