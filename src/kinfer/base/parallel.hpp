// The one way to use several cores: pure items that each write their own slot.
//
// Items are handed out in order to a pool that lives as long as the program. Nested calls run their items one after
// the other, so that a parallel caller decides alone. Which thread runs an item must not matter to its result.
#pragma once

#include <cstddef>
#include <functional>

namespace kinfer {

/// Number of threads that the machine offers (at least 1).
int hardware_threads();

/// Calls body(i) for i = 0 .. count-1 on at most `threads` threads (0: all cores); returns when all are done.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

}  // namespace kinfer
