// The displacement gradient of one point, or of several points side by side.
#pragma once

namespace kerf::fem {

/// H = du/dX, so that F = 1 + H; `xy` is du_x/dY. In 2D `zz` is the stretch of the third axis (out
/// of plane, or the hoop) minus one.
template <class Number, int dim> struct Gradient;

template <class Number> struct Gradient<Number, 2> { Number xx, xy, yx, yy, zz; };
template <class Number> struct Gradient<Number, 3> { Number xx, xy, xz, yx, yy, yz, zx, zy, zz; };

/// Sum of the principal minors of order two, and the determinant: J - 1 = tr H + minors + det H.
template <class Number>
[[gnu::always_inline]] inline Number nonlinear_volume(const Gradient<Number, 2>& H) {
  const Number minor = H.xx * H.yy - H.xy * H.yx;
  return minor + H.zz * (H.xx + H.yy + minor);
}
template <class Number>
[[gnu::always_inline]] inline Number nonlinear_volume(const Gradient<Number, 3>& H) {
  const Number minor_x = H.yy * H.zz - H.yz * H.zy;
  return minor_x + (H.xx * H.yy - H.xy * H.yx) + (H.xx * H.zz - H.xz * H.zx) + H.xx * minor_x +
         H.xy * (H.yz * H.zx - H.yx * H.zz) + H.xz * (H.yx * H.zy - H.yy * H.zx);
}

/// J - 1 without cancellation, J = det(1 + H).
template <class Number, int dim>
[[gnu::always_inline]] inline Number volume_change(const Gradient<Number, dim>& H) {
  return H.xx + H.yy + H.zz + nonlinear_volume(H);
}

} // namespace kerf::fem
