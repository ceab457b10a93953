/* The commands, one file each. */
#ifndef QN_CLI_COMMANDS_H
#define QN_CLI_COMMANDS_H

#include "cli/options.h"

extern const cli_command cli_render_command, cli_query_command, cli_ray_command, cli_check_command, cli_tree_command, cli_scene_command;

#endif
