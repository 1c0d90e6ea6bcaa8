// Symmetric tensors of one point, or of several points side by side.
#pragma once

namespace kerf::fem {

/// Stress or strain with tension positive: xx, yy, zz, then the shear components of the tensor: xy
/// in 2D (the third axis is out of plane, or the hoop), yz, xz, xy in 3D. Shear is not doubled.
/// @tparam Number  double, or the lanes of a vector of the processor
template <class Number, int dim> struct Symmetric {
  static constexpr int size = dim == 2 ? 4 : 6;
  Number c[size];

  [[gnu::always_inline]] Number& operator[](int k) { return c[k]; }
  [[gnu::always_inline]] const Number& operator[](int k) const { return c[k]; }
};

template <class Number, int dim>
[[gnu::always_inline]] inline Symmetric<Number, dim> operator+(const Symmetric<Number, dim>& a,
                                                               const Symmetric<Number, dim>& b) {
  Symmetric<Number, dim> sum;
  for (int k = 0; k < a.size; ++k)
    sum[k] = a[k] + b[k];
  return sum;
}
template <class Number, int dim>
[[gnu::always_inline]] inline Symmetric<Number, dim> operator-(const Symmetric<Number, dim>& a,
                                                               const Symmetric<Number, dim>& b) {
  Symmetric<Number, dim> difference;
  for (int k = 0; k < a.size; ++k)
    difference[k] = a[k] - b[k];
  return difference;
}
/// @param factor  one of each point, or a double for all of them
template <class Factor, class Number, int dim>
[[gnu::always_inline]] inline Symmetric<Number, dim> operator*(const Factor& factor,
                                                               const Symmetric<Number, dim>& a) {
  Symmetric<Number, dim> product;
  for (int k = 0; k < a.size; ++k)
    product[k] = factor * a[k];
  return product;
}

template <class Number, int dim>
[[gnu::always_inline]] inline Number trace(const Symmetric<Number, dim>& a) {
  return a[0] + a[1] + a[2];
}

/// a + p 1
template <class Number, int dim>
[[gnu::always_inline]] inline Symmetric<Number, dim> plus_isotropic(const Symmetric<Number, dim>& a,
                                                                    const Number& p) {
  Symmetric<Number, dim> sum = a;
  for (int k = 0; k < 3; ++k)
    sum[k] = sum[k] + p;
  return sum;
}

/// a - tr(a)/3 1
template <class Number, int dim>
[[gnu::always_inline]] inline Symmetric<Number, dim> deviator(const Symmetric<Number, dim>& a) {
  return plus_isotropic<Number, dim>(a, (-1.0 / 3.0) * trace(a));
}

/// a : b
template <class Number, int dim>
[[gnu::always_inline]] inline Number contract(const Symmetric<Number, dim>& a,
                                              const Symmetric<Number, dim>& b) {
  Number shear = a[3] * b[3];
  for (int k = 4; k < Symmetric<Number, dim>::size; ++k)
    shear = shear + a[k] * b[k];
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * shear;
}

} // namespace kerf::fem
