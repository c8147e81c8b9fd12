// Residuals, their derivative and the normal equations of many points at one candidate: lanes are points. Included by
// the kernel files only.
//
// A walk from the world outwards notes the axis and origin of every parameter's motion; at the tool each becomes a
// column (axis × lever, or axis). The normal equations grow chunk by chunk, so that no Jacobian need be kept.
#pragma once

#include "kinfer/kinematics/batch_kernel.hpp"
#include "kinfer/kinematics/batch_pack.hpp"

namespace kinfer::batch {
namespace {  // each kernel file has its own, compiled for its processor

/// Frames in flight at the same time: rotations r[3 row + column] and positions t.
template <class V, int n>
struct Frames {
  V r[9][n], t[3][n];
};

template <class V, int n, int axis>
inline void turn(Frames<V, n>& f, const V (&c)[n], const V (&s)[n]) {
  constexpr int i = axis == 2 ? 0 : axis + 1, j = 3 - axis - i;
  for (int row = 0; row < 3; ++row)
    for (int u = 0; u < n; ++u) {
      const V p = f.r[3 * row + i][u], q = f.r[3 * row + j][u];
      f.r[3 * row + i][u] = mul_add(c[u], p, s[u] * q);
      f.r[3 * row + j][u] = mul_sub(c[u], q, s[u] * p);
    }
}

template <class V, int n>
inline void turn(Frames<V, n>& f, int axis, const V (&c)[n], const V (&s)[n]) {
  if (axis == 0) turn<V, n, 0>(f, c, s);
  if (axis == 1) turn<V, n, 1>(f, c, s);
  if (axis == 2) turn<V, n, 2>(f, c, s);
}

template <class V, int n>
inline void shift(Frames<V, n>& f, int axis, const V (&length)[n]) {
  for (int row = 0; row < 3; ++row)
    for (int u = 0; u < n; ++u) f.t[row][u] = mul_add(length[u], f.r[3 * row + axis][u], f.t[row][u]);
}

template <class V, int n>
inline void rotate(Frames<V, n>& f, const double* by) {
  for (int row = 0; row < 3; ++row)
    for (int u = 0; u < n; ++u) {
      const V p[3] = {f.r[3 * row][u], f.r[3 * row + 1][u], f.r[3 * row + 2][u]};
      for (int col = 0; col < 3; ++col)
        f.r[3 * row + col][u] = mul_add(p[0], broadcast<V>(by[col]),
                                        mul_add(p[1], broadcast<V>(by[3 + col]), p[2] * broadcast<V>(by[6 + col])));
    }
}

/// n blocks of points walked through the steps together.
template <class V, int n>
class Walk {
 public:
  static constexpr int lanes = Traits<V>::lanes;

  /// `columns`: 6 n packs a column, for axes and origins.
  Walk(const JacobianJob& job, int block, double* columns) : job_(job), block_(block), columns_(columns) {
    for (int u = 0; u < n; ++u) {
      for (int i = 0; i < 9; ++i) f_.r[i][u] = broadcast<V>(i % 4 == 0 ? 1.0 : 0.0);
      for (int i = 0; i < 3; ++i) f_.t[i][u] = broadcast<V>(0.0);
    }
  }

  void to_the_tool(const double* on_tool) {
    for (int i = 0; i < job_.step_count; ++i) take(job_.steps[i]);
    for (int axis = 0; axis < 3; ++axis) {
      V length[n];
      fill(length, on_tool[axis]);
      if (on_tool[axis] != 0.0) shift(f_, axis, length);
    }
  }

  /// Residual and columns of block u, weighted: `to` is where row 0 of column 0 goes, columns are `apart` numbers
  /// apart; the residual is the column after the last.
  void finish(int u, double* to, std::ptrdiff_t apart, double* residuals) const {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(block_ + u) * 3 * lanes;
    V weight[3];
    for (int row = 0; row < 3; ++row) {
      weight[row] = load<V>(job_.weights + at + row * lanes);
      const V residual = weight[row] * (datum(u, job_.stride - 3 + row) - f_.t[row][u]);
      store(residuals + row * lanes, residual);
    }
    for (int i = 0; i < job_.step_count; ++i) {
      const Step& step = job_.steps[i];
      if (step.kind == Step::Kind::record_turn) finish_turn(step.column, u, weight, to + step.column * apart);
      if (step.kind == Step::Kind::record_shift) finish_shift(step.column, u, weight, to + step.column * apart);
    }
    for (int i = 0; i < job_.idle_count; ++i)
      for (int row = 0; row < 3; ++row) store(to + job_.idle[i] * apart + row * lanes, broadcast<V>(0.0));
  }

 private:
  double* noted(int column, int i, int u) const { return columns_ + ((column * 6 + i) * n + u) * lanes; }

  static void fill(V (&to)[n], double value) {
    for (int u = 0; u < n; ++u) to[u] = broadcast<V>(value);
  }

  V datum(int u, int slot) const {
    return load<V>(job_.items + (static_cast<std::ptrdiff_t>(block_ + u) * job_.stride + slot) * lanes);
  }

  void take(const Step& step) {
    V first[n], second[n];
    switch (step.kind) {
      case Step::Kind::turn:
        fill(first, step.a), fill(second, step.b);
        return turn(f_, step.axis, first, second);
      case Step::Kind::shift:
        fill(first, step.a);
        return shift(f_, step.axis, first);
      case Step::Kind::rotation:
        return rotate(f_, step.rotation);
      case Step::Kind::turn_joint:
        return turn_joint(step);
      case Step::Kind::shift_joint:
        return shift_joint(step);
      case Step::Kind::record_turn:
      case Step::Kind::record_shift:
        return note(step);
    }
  }

  /// By the sum of the joint's movement and the offset.
  void turn_joint(const Step& step) {
    V c[n], s[n];
    const V a = broadcast<V>(step.a), b = broadcast<V>(step.b);
    for (int u = 0; u < n; ++u) {
      const V moved_c = datum(u, step.slot), moved_s = datum(u, step.slot + 1);
      c[u] = mul_sub(a, moved_c, b * moved_s);
      s[u] = mul_add(a, moved_s, b * moved_c);
    }
    turn(f_, step.axis, c, s);
    if (step.extra_gain == 0.0) return;
    for (int u = 0; u < n; ++u) {
      const SinCos<V> more = sin_cos(broadcast<V>(step.extra_gain) * datum(u, step.slot + 2));
      c[u] = more.cos, s[u] = more.sin;
    }
    turn(f_, step.axis, c, s);
  }

  void shift_joint(const Step& step) {
    V length[n];
    for (int u = 0; u < n; ++u) length[u] = broadcast<V>(step.a) + datum(u, step.slot);
    if (step.extra_gain != 0.0)
      for (int u = 0; u < n; ++u)
        length[u] = mul_add(broadcast<V>(step.extra_gain), datum(u, step.slot + 2), length[u]);
    shift(f_, step.axis, length);
  }

  void note(const Step& step) {
    for (int row = 0; row < 3; ++row)
      for (int u = 0; u < n; ++u) {
        V axis = f_.r[3 * row + step.axis][u];
        if (step.slot >= 0) axis *= datum(u, step.slot);
        store(noted(step.column, row, u), axis);
        if (step.kind == Step::Kind::record_turn) store(noted(step.column, 3 + row, u), f_.t[row][u]);
      }
  }

  void finish_turn(int column, int u, const V* weight, double* to) const {
    V axis[3], lever[3];
    for (int row = 0; row < 3; ++row) {
      axis[row] = load<V>(noted(column, row, u));
      lever[row] = load<V>(noted(column, 3 + row, u)) - f_.t[row][u];  // of − d residual
    }
    for (int row = 0; row < 3; ++row) {
      const int i = (row + 1) % 3, j = (row + 2) % 3;
      store(to + row * lanes, weight[row] * mul_sub(axis[i], lever[j], axis[j] * lever[i]));
    }
  }

  void finish_shift(int column, int u, const V* weight, double* to) const {
    for (int row = 0; row < 3; ++row) store(to + row * lanes, -weight[row] * load<V>(noted(column, row, u)));
  }

  const JacobianJob& job_;
  int block_;
  double* columns_;
  Frames<V, n> f_;
};

/// [J r]ᵀ[J r] as it grows: 4 x 3 products a tile, each still spread over the lanes.
template <class V>
class Gram {
 public:
  static constexpr int lanes = Traits<V>::lanes, tall = tile_height, wide = tile_width;

  Gram(int size, double* tiles) : size_(size), tiles_(tiles) {
    for_each_tile([](int, int, double* tile) {
      for (int i = 0; i < tall * wide; ++i) store(tile + i * lanes, broadcast<V>(0.0));
    });
  }

  /// Adds the rows of a chunk: column k is at `chunk + k · apart`, `rows` packs of it.
  void add(const double* chunk, std::ptrdiff_t apart, int rows) {
    for_each_tile([&](int i0, int j0, double* tile) {
      V sum[tall][wide];
      for (int i = 0; i < tall * wide; ++i) sum[i / wide][i % wide] = load<V>(tile + i * lanes);
      const double *left = chunk + i0 * apart, *right = chunk + j0 * apart;
      for (int row = 0; row < rows; ++row, left += lanes, right += lanes) {
        V r[wide];
        for (int j = 0; j < wide; ++j) r[j] = load<V>(right + j * apart);
        for (int i = 0; i < tall; ++i) {
          const V l = load<V>(left + i * apart);
          for (int j = 0; j < wide; ++j) sum[i][j] = mul_add(l, r[j], sum[i][j]);
        }
      }
      for (int i = 0; i < tall * wide; ++i) store(tile + i * lanes, sum[i / wide][i % wide]);
    });
  }

  /// Lower half, row i of the result after row i − 1.
  void write(double* to) const {
    for_each_tile([&](int i0, int j0, const double* tile) {
      for (int i = 0; i < tall; ++i)
        for (int j = 0; j < wide; ++j) {
          if (i0 + i >= size_ || j0 + j > i0 + i) continue;
          to[(i0 + i) * size_ + j0 + j] = lane_sum(tile + (i * wide + j) * lanes);
        }
    });
  }

 private:
  /// Pairwise, so that the additions need not wait for each other.
  static double lane_sum(const double* pack) {
    double sum[lanes];
    for (int lane = 0; lane < lanes; ++lane) sum[lane] = pack[lane];
    for (int half = lanes / 2; half > 0; half /= 2)
      for (int lane = 0; lane < half; ++lane) sum[lane] += sum[lane + half];
    return sum[0];
  }

  template <class F>
  void for_each_tile(F&& f) const {
    double* tile = tiles_;
    for (int i0 = 0; i0 < size_; i0 += tall)
      for (int j0 = 0; j0 < i0 + tall && j0 < size_; j0 += wide, tile += tall * wide * lanes) f(i0, j0, tile);
  }

  int size_;
  double* tiles_;
};

template <class V>
class JacobianKernel {
 public:
  static constexpr int lanes = Traits<V>::lanes, in_flight = blocks_in_flight;

  explicit JacobianKernel(const JacobianJob& job)
      : job_(job),
        noted_(job.workspace),
        chunk_(noted_ + job.columns * 6 * in_flight * lanes),
        gram_(job.columns + 1, chunk_ + padded_columns(job.columns) * apart) {
    for (int k = job.columns + 1; k < padded_columns(job.columns); ++k)
      for (int i = 0; i < apart; ++i) chunk_[k * apart + i] = 0.0;
  }

  void run() {
    for (int g = 0; g < job_.group_count; ++g) {
      const Group& group = job_.groups[g];
      int block = group.begin;
      for (; block + in_flight <= group.end; block += in_flight) walk<in_flight>(block, group.on_tool);
      for (; block < group.end; ++block) walk<1>(block, group.on_tool);
    }
    add_chunk();
    if (!job_.jacobian) gram_.write(job_.normal);
  }

 private:
  static constexpr int apart = 3 * blocks_a_chunk * lanes;

  template <int n>
  void walk(int block, const double* on_tool) {
    if (in_chunk_ + n > blocks_a_chunk) add_chunk();
    Walk<V, n> walk(job_, block, noted_);
    walk.to_the_tool(on_tool);
    for (int u = 0; u < n; ++u) {
      double* residuals = job_.residuals + static_cast<std::ptrdiff_t>(block + u) * 3 * lanes;
      if (job_.jacobian) {
        const std::ptrdiff_t column = static_cast<std::ptrdiff_t>(job_.blocks) * 3 * lanes;
        walk.finish(u, job_.jacobian + static_cast<std::ptrdiff_t>(block + u) * 3 * lanes, column, residuals);
      } else {
        double* to = chunk_ + in_chunk_ * 3 * lanes;
        walk.finish(u, to, apart, residuals);
        for (int row = 0; row < 3; ++row)
          store(to + job_.columns * apart + row * lanes, load<V>(residuals + row * lanes));
        ++in_chunk_;
      }
    }
  }

  void add_chunk() {
    if (in_chunk_ > 0) gram_.add(chunk_, apart, 3 * in_chunk_);
    in_chunk_ = 0;
  }

  const JacobianJob& job_;
  double *noted_, *chunk_;
  Gram<V> gram_;
  int in_chunk_ = 0;
};

template <class V>
void jacobian(const JacobianJob& job) {
  JacobianKernel<V>(job).run();
}

}  // namespace
}  // namespace kinfer::batch
