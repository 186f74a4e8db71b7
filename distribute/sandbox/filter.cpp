// SPDX-License-Identifier: AGPL-3.0-or-later
#include "distribute/sandbox/filter.h"

#include "distribute/common/error.h"

#include <cerrno>
#include <memory>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace farm {

int make_filter() {
	const std::unique_ptr<void, decltype(&seccomp_release)> filter(seccomp_init(SCMP_ACT_ALLOW), seccomp_release);
	int failed = filter ? 0 : -ENOMEM;
	const auto forbid = [&](int call, int error) {
		if (const int result = seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(static_cast<unsigned>(error)), call, 0); !failed)
			failed = result;
	};
	for (const int call : {SCMP_SYS(fork), SCMP_SYS(vfork), SCMP_SYS(socket), SCMP_SYS(socketpair), SCMP_SYS(ptrace),
			 SCMP_SYS(process_vm_readv), SCMP_SYS(process_vm_writev), SCMP_SYS(unshare), SCMP_SYS(setns), SCMP_SYS(mount),
			 SCMP_SYS(umount2), SCMP_SYS(pivot_root), SCMP_SYS(bpf), SCMP_SYS(perf_event_open), SCMP_SYS(userfaultfd),
			 SCMP_SYS(keyctl), SCMP_SYS(add_key), SCMP_SYS(request_key), SCMP_SYS(memfd_create), SCMP_SYS(open_by_handle_at)})
		forbid(call, EPERM);
	// Its arguments are in memory, where no filter looks. The C library then uses clone. io_uring goes past filters.
	for (const int call : {SCMP_SYS(clone3), SCMP_SYS(io_uring_setup)})
		forbid(call, ENOSYS);
	if (!failed)
		failed = seccomp_rule_add(
			filter.get(), SCMP_ACT_ERRNO(EPERM), SCMP_SYS(clone), 1, SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0));
	for (const unsigned long request : {TIOCSTI, TIOCLINUX})
		if (!failed)
			failed = seccomp_rule_add(
				filter.get(), SCMP_ACT_ERRNO(EPERM), SCMP_SYS(ioctl), 1, SCMP_A1(SCMP_CMP_MASKED_EQ, 0xffffffff, request));
	const int file = failed ? -1 : ::memfd_create("bhfarm-filter", MFD_CLOEXEC);
	if (file >= 0)
		failed = seccomp_export_bpf(filter.get(), file);
	if (failed || file < 0) {
		if (file >= 0)
			::close(file);
		errno = failed ? -failed : errno;
		throw system_error("cannot make the filter of system calls");
	}
	return file;
}

} // namespace farm
