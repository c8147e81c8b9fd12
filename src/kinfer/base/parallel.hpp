// SPDX-License-Identifier: Apache-2.0
// Parallel loop over independent items that each write only their own slot: the only use of threads in the library.
//
// Items are dispatched in order to a thread pool that lives as long as the program. Nested calls run serially, so that
// only the outermost loop is parallel. The result of an item must not depend on the thread that runs it.
#pragma once

#include <cstddef>
#include <functional>

namespace kinfer {

/// Number of hardware threads (at least 1).
int hardware_threads();

/// Calls body(i) for i = 0 .. count-1 on at most `threads` threads (0: all cores); returns when all are done. Where a
/// body throws, as an observer may, the items that are not begun are left out and the exception reaches the caller.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

}  // namespace kinfer
