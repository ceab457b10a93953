/* The command quoin: which command, help and version. It uses the public headers only. */
#include "cli/commands.h"
#include "cli/out.h"
#include "cli/say.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

static const cli_command *const commands[] = {&cli_render_command, &cli_query_command, &cli_ray_command,
                                              &cli_check_command,  &cli_tree_command,  &cli_scene_command};
enum { COMMANDS = sizeof commands / sizeof *commands };

/* A closed standard stream would lend its number to the next file opened, and output would land in it. The stand-ins are
   opened the wrong way round, so that using them fails as it would have. */
static void keep_standard_streams(void) {
  for (int fd = 0; fd < 3; fd++) {
    if (fcntl(fd, F_GETFD) == -1) {
      int stand_in = open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
      (void)stand_in; /* the lowest free number, so fd itself */
    }
  }
}

static int print(const cli_text *text) {
  cli_out out;
  cli_out_open(&out, NULL);
  cli_out_text(&out, text);
  return cli_out_close(&out, 1);
}

static void put_usage(cli_text *text) {
  cli_puts(text, "Usage: quoin COMMAND [OPTION ...] MODEL ...\n"
                 "An exact CSG solid modeller: curved solids stay curved and no answer depends on a tolerance.\n\nCommands:\n");
  for (int i = 0; i < COMMANDS; i++) {
    cli_putf(text, "  %-8s %s\n", commands[i]->name, commands[i]->summary);
  }
  cli_puts(text, "\n'quoin COMMAND --help' tells more of each; 'quoin --version' prints the version.\n");
}

static int print_usage(void) {
  cli_text text = {0};
  put_usage(&text);
  int code = print(&text);
  cli_text_free(&text);
  return code;
}

static int print_version(void) {
  cli_text text = {0};
  cli_putf(&text, "quoin %s\n", quoin_version());
  int code = print(&text);
  cli_text_free(&text);
  return code;
}

static const cli_command *find(const char *name) {
  for (int i = 0; i < COMMANDS; i++) {
    if (strcmp(commands[i]->name, name) == 0) {
      return commands[i];
    }
  }
  return NULL;
}

static const char *command_name(const void *user, int i) {
  (void)user;
  return i < COMMANDS ? commands[i]->name : NULL;
}

static const char *main_option_name(const void *user, int i) {
  (void)user;
  static const char *const names[] = {"--help", "--version", NULL};
  return names[i];
}

static int unknown(const char *word) {
  cli_quoted q;
  const char *nearest = word[0] == '-' ? cli_nearest(word, main_option_name, NULL) : cli_nearest(word, command_name, NULL);
  const char *what = word[0] == '-' ? "option" : "command";
  if (nearest) {
    cli_error("unknown %s %s; did you mean '%s'?", what, cli_quote(&q, word), nearest);
  } else if (word[0] != '-' && access(word, F_OK) == 0) {
    cli_error("unknown command %s; the command comes before the model, for instance quoin check MODEL", cli_quote(&q, word));
  } else {
    cli_error("unknown %s %s", what, cli_quote(&q, word));
  }
  return cli_try_help(NULL);
}

static int is_help(const char *word) { return strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0; }

int main(int argc, char **argv) {
  keep_standard_streams();
  (void)signal(SIGPIPE, SIG_IGN); /* a reader that went away shows up as an error of write, and is dealt with there */
  const char *word = argc > 1 ? argv[1] : NULL;
  if (!word) {
    cli_error("no command given");
    return cli_try_help(NULL);
  }
  const int help = strcmp(word, "help") == 0;
  if (is_help(word) || (help && (argc == 2 || is_help(argv[2])))) {
    return print_usage();
  }
  if (strcmp(word, "--version") == 0 || strcmp(word, "-V") == 0) {
    return print_version();
  }
  if (help) {
    const cli_command *command = find(argv[2]);
    return command ? cli_help(command) : unknown(argv[2]);
  }
  const cli_command *command = find(word);
  return command ? command->run(command, argc - 2, argv + 2) : unknown(word);
}
