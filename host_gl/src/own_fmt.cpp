// SPDX-License-Identifier: MIT
// fmt inside the libraries that other people's programs load: such a program may have brought a libfmt, and a C++
// runtime for it, of its own. Debian has no static libfmt; this is what one would hold of what its headers leave out.
#include <fmt/format-inl.h>

FMT_BEGIN_NAMESPACE
namespace detail {

template thousands_sep_result<char> thousands_sep_impl<char>(locale_ref);
template char decimal_point_impl<char>(locale_ref);

namespace dragonbox {
template decimal_fp<float> to_decimal<float>(float) noexcept;
template decimal_fp<double> to_decimal<double>(double) noexcept;
}  // namespace dragonbox

}  // namespace detail
FMT_END_NAMESPACE
