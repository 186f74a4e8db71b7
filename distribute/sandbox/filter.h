// SPDX-License-Identifier: AGPL-3.0-or-later
/// The system calls a render has no use for.
#ifndef FARM_FILTER_H
#define FARM_FILTER_H

namespace farm {

/// A descriptor with a filter for bubblewrap's --seccomp: no new processes (threads are allowed), no sockets, no typing into a
/// terminal, nothing that changes namespaces or looks into processes. As no process can have children, what the kernel limits for
/// one process holds for the whole render. Throws Error.
int make_filter();

} // namespace farm
#endif
