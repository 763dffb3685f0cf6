// SPDX-License-Identifier: Apache-2.0
#pragma once
// Process 1, which a program is that a container starts: the system gives it all orphans to reap,
// and delivers it no signal that it does not ask for.

namespace hc {

/// In process 1, forks: the caller continues in the child, while process 1 reaps orphans, passes
/// signals on to the child, and ends with its status. Elsewhere does nothing. Call it before there
/// are threads.
void leave_first_process();

}  // namespace hc
