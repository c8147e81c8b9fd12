// SPDX-License-Identifier: Apache-2.0
// For packages: a failed check of the standard library (_GLIBCXX_ASSERTIONS) stops the program without its words. The
// names and conditions of thousands of checks would take a tenth of the program. Included before everything else.
#pragma once

#include <cstddef>

#if defined(_GLIBCXX_ASSERTIONS) && defined(__glibcxx_assert_impl)
#undef __glibcxx_assert_impl
#define __glibcxx_assert_impl(condition)           \
  if (__builtin_expect(!bool(condition), false)) { \
    __glibcxx_constexpr_assert(false);             \
    __builtin_trap();                              \
  }
// Of strings, those in the standard library's own shared object are taken, which do not check themselves.
#undef _GLIBCXX_EXTERN_TEMPLATE
#define _GLIBCXX_EXTERN_TEMPLATE 1
#endif
