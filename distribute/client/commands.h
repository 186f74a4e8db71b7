// SPDX-License-Identifier: AGPL-3.0-or-later
/// bhfarm's commands. Each takes the words after its own name and returns the exit code; throws Error.
#ifndef FARM_COMMANDS_H
#define FARM_COMMANDS_H

#include "distribute/common/arguments.h"

#include <string>
#include <vector>

namespace farm {

using Words = std::vector<std::string>;

int render_command(const Words& words);
int submit_command(const Words& words);
int status_command(const Words& words);
int watch_command(const Words& words);
int workers_command(const Words& words);
int log_command(const Words& words);
int fetch_command(const Words& words);
int drain_command(const Words& words);
int remove_command(const Words& words);
int slurm_command(const Words& words);
int token_command(const Words& words);
int source_command(const Words& words);
/// cancel, pause, resume, retry.
int change_command(const std::string& what, const Words& words);

} // namespace farm
#endif
