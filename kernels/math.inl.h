// Elementary functions on xsimd batches: exp, erf, tanh, sigmoid and the activations made of them.
// The coefficients are our own least-maximum fits (docs/numerics.md states the measured errors); a
// few ULP buys functions without tables or branches.  NaN goes through, +-0 and +-inf are exact.
#ifndef GESTUS_KERNELS_MATH_INL_H_
#define GESTUS_KERNELS_MATH_INL_H_

#include <cstdint>
#include <limits>
#include <type_traits>
#include <xsimd/xsimd.hpp>

#include "kernels/kernels.h"

namespace gestus::kernels {
namespace {

/// x * y + z, in one rounding where the instruction set has a fused multiply-add.
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> multiply_add(
    const xsimd::batch<float, Arch>& x, const xsimd::batch<float, Arch>& y,
    const xsimd::batch<float, Arch>& z) {
#if defined(__AVX512F__)
  // xsimd 8.1 has no fused multiply-add for AVX-512: its generic one rounds twice.
  if constexpr (xsimd::batch<float, Arch>::size == 16) return _mm512_fmadd_ps(x, y, z);
#elif defined(__aarch64__)
  // xsimd 8.1 calls vmlaq_f32, which rounds twice.
  return vfmaq_f32(z, x, y);
#endif
  return xsimd::fma(x, y, z);
}

/// Horner's rule: c0 + x * (c1 + x * (...)).
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> polynomial(const xsimd::batch<float, Arch>&,
                                                                   float c0) {
  return xsimd::batch<float, Arch>(c0);
}
template <class Arch, class... C>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> polynomial(
    const xsimd::batch<float, Arch>& x, float c0, C... rest) {
  return multiply_add(x, polynomial(x, rest...), xsimd::batch<float, Arch>(c0));
}

/// e^x.  Results below 2^-126 are zero in all code that runs with denormals flushed.
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> vexp(const xsimd::batch<float, Arch>& of) {
  using B = xsimd::batch<float, Arch>;
  using I = xsimd::batch<std::int32_t, Arch>;
  B x = of;
#if defined(__AVX512F__)
  // Outside of these the result is zero or infinite anyway.  NaN, the second operand, stays.
  if constexpr (B::size == 16) x = _mm512_min_ps(B(89.0f), _mm512_max_ps(B(-105.0f), x));
#endif
  // Adding 1.5 * 2^23 rounds x / ln 2 to an integer n and leaves n in the low bits of the sum.
  const B shifter(12582912.0f);
  const B shifted = multiply_add(x, B(1.44269504f), shifter);
  const B n = shifted - shifter;
  // ln 2 in two parts; the first has so few bits that n times it is exact.
  B r = multiply_add(n, B(-0.693359375f), x);
  r = multiply_add(n, B(2.12194440e-4f), r);
  const B p =
      polynomial(r, 0.49999994f, 0.166665211f, 0.041668389f, 0.00836874545f, 0.00138145394f);
  const B e = B(1.0f) + multiply_add(r * r, p, r);
#if defined(__AVX512F__)
  if constexpr (B::size == 16) return _mm512_scalef_ps(e, n);
#endif
  // n goes straight into the exponent of e, which is in (0.7, 1.42).
  const I bits = xsimd::bitwise_cast<I>(e) + (xsimd::bitwise_cast<I>(shifted) << 23);
  const B y = xsimd::select(x < B(-87.33654f), B(0.0f), xsimd::bitwise_cast<B>(bits));
  // x + inf is inf for the large and NaN for NaN.
  return xsimd::select(x <= B(88.7228317f), y, x + B(std::numeric_limits<float>::infinity()));
}

/// An odd function that saturates at +-1 beyond `limit`: sign(x) |x| num / den, the two being
/// polynomials in x^2.
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> saturating_odd(
    const xsimd::batch<float, Arch>& x, float limit, const xsimd::batch<float, Arch>& num,
    const xsimd::batch<float, Arch>& den) {
  using B = xsimd::batch<float, Arch>;
  const B sign = x & B(-0.0f);
  const B ax = x ^ sign;
  const B y = ax * num / den;
  return xsimd::select(ax >= B(limit), B(1.0f), y) | sign;
}

/// The error function.
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> verf(const xsimd::batch<float, Arch>& x) {
  const xsimd::batch<float, Arch> u = x * x;
  return saturating_odd(x, 3.92f,
                        polynomial(u, 1.12837911f, 0.190407619f, 0.0527488701f, 0.00376566523f,
                                   2.84883456e-4f, 2.050077e-6f),
                        polynomial(u, 1.0f, 0.502077103f, 0.114109576f, 0.0149693154f,
                                   1.16254645e-3f, 3.80916244e-5f));
}

template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> vtanh(const xsimd::batch<float, Arch>& x) {
  const xsimd::batch<float, Arch> u = x * x;
  return saturating_odd(
      x, 9.01f, polynomial(u, 1.0f, 0.133797228f, 3.49404104e-3f, 2.0583564e-5f, 1.33192195e-8f),
      polynomial(u, 1.0f, 0.467130393f, 0.0258710962f, 3.28310241e-4f, 7.7620706e-7f));
}

/// 1 / (1 + e^-x): the exponential keeps the relative error of the far negative side small.
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> vsigmoid(
    const xsimd::batch<float, Arch>& x) {
  using B = xsimd::batch<float, Arch>;
  return B(1.0f) / (B(1.0f) + vexp(-x));
}

/// x / 2 for the two GELUs, bounded below where they are zero, so that -inf does not become
/// inf - inf.
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> gelu_half(
    const xsimd::batch<float, Arch>& x) {
  using B = xsimd::batch<float, Arch>;
  return B(0.5f) * xsimd::max(x, B(-16.0f));
}

/// x Phi(x) = x/2 (1 + erf(x / sqrt 2)).
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> vgelu_erf(
    const xsimd::batch<float, Arch>& x) {
  using B = xsimd::batch<float, Arch>;
  const B half = gelu_half(x);
  return multiply_add(half, verf(x * B(0.707106781f)), half);
}

/// x/2 (1 + tanh(sqrt(2 / pi) (x + 0.044715 x^3))).
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> vgelu_tanh(
    const xsimd::batch<float, Arch>& x) {
  using B = xsimd::batch<float, Arch>;
  const B half = gelu_half(x);
  const B inner = x * multiply_add(x * x, B(0.0356774081f), B(0.797884561f));
  return multiply_add(half, vtanh(inner), half);
}

/// act(x), chosen at compile time: the inner loop of a matrix product must not branch on it.
template <Activation act, class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> apply_activation(
    const xsimd::batch<float, Arch>& x, const xsimd::batch<float, Arch>& alpha) {
  using B = xsimd::batch<float, Arch>;
  if constexpr (act == Activation::kRelu) return xsimd::select(x < B(0.0f), B(0.0f), x);
  if constexpr (act == Activation::kLeakyRelu) return xsimd::select(x < B(0.0f), alpha * x, x);
  if constexpr (act == Activation::kGeluErf) return vgelu_erf(x);
  if constexpr (act == Activation::kGeluTanh) return vgelu_tanh(x);
  if constexpr (act == Activation::kTanh) return vtanh(x);
  if constexpr (act == Activation::kSigmoid) return vsigmoid(x);
  return x;
}

/// Calls f(std::integral_constant<Activation, act>) for the `act` known at run time.
template <class F>
[[gnu::always_inline]] inline void with_activation(Activation act, const F& f) {
  switch (act) {
    case Activation::kNone:
      return f(std::integral_constant<Activation, Activation::kNone>{});
    case Activation::kRelu:
      return f(std::integral_constant<Activation, Activation::kRelu>{});
    case Activation::kLeakyRelu:
      return f(std::integral_constant<Activation, Activation::kLeakyRelu>{});
    case Activation::kGeluErf:
      return f(std::integral_constant<Activation, Activation::kGeluErf>{});
    case Activation::kGeluTanh:
      return f(std::integral_constant<Activation, Activation::kGeluTanh>{});
    case Activation::kTanh:
      return f(std::integral_constant<Activation, Activation::kTanh>{});
    case Activation::kSigmoid:
      return f(std::integral_constant<Activation, Activation::kSigmoid>{});
  }
}

/// act(x), chosen at run time.
template <class Arch>
[[gnu::always_inline]] inline xsimd::batch<float, Arch> apply_activation(
    Activation act, const xsimd::batch<float, Arch>& x, const xsimd::batch<float, Arch>& alpha) {
  xsimd::batch<float, Arch> y = x;
  with_activation(act, [&](auto known) { y = apply_activation<known()>(x, alpha); });
  return y;
}

}  // namespace
}  // namespace gestus::kernels

#endif  // GESTUS_KERNELS_MATH_INL_H_
