/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run/confinement.h"

#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

// Exit codes of the child: what it found to be otherwise than it should be.
enum { AS_IT_SHOULD, NOT_CONFINED, INSIDE, OUTSIDE, OPEN_ONE, DEVICE, SOCKET, READING, FORKED };

static int try_to_write(const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0)
        return errno;
    close(file);
    return 0;
}

static int what_is_left(void)
{
    const char *folders[] = {"in", "not/there", "out/given"};
    cp_error error = {0};
    int open_one = open("out/open", O_WRONLY | O_CREAT, 0600);
    if (cp_confine(folders, 3, &error) != CP_OK)
        return NOT_CONFINED;
    if (try_to_write("in/new") != 0 || rename("in/new", "in/other") != 0 ||
        unlink("in/other") != 0 || try_to_write("in/below/new") != 0)
        return INSIDE;
    if (cp_confinement_has_folders() &&
        (try_to_write("out/new") != EACCES || try_to_write("out/there") != EACCES ||
         try_to_write("in/../out/new") != EACCES || try_to_write("in/link") != EACCES ||
         unlink("out/there") == 0 || mkdir("out/folder", 0700) == 0 ||
         symlink("x", "in/another") == 0 || mkfifo("in/pipe", 0600) == 0 ||
         rename("out/there", "in/there") == 0))
        return OUTSIDE;
    if (write(open_one, "x", 1) != 1 || try_to_write("out/given") != 0)
        return OPEN_ONE;
    if (try_to_write("/dev/null") != 0)
        return DEVICE;
    if (socket(AF_INET, SOCK_STREAM, 0) >= 0 || errno != EACCES ||
        socket(AF_UNIX, SOCK_STREAM, 0) >= 0)
        return SOCKET;
    int readable = open("out/there", O_RDONLY);
    return readable >= 0 ? AS_IT_SHOULD : READING;
}

static int of_child_of_child(void)
{
    const char *folders[] = {"in"};
    cp_error error = {0};
    if (cp_confine(folders, 1, &error) != CP_OK)
        return NOT_CONFINED;
    int ended = 0;
    pid_t child = fork();
    if (child == 0)
        _exit(cp_confinement_has_folders() && try_to_write("out/new") != EACCES);
    waitpid(child, &ended, 0);
    return WIFEXITED(ended) && WEXITSTATUS(ended) == 0 ? AS_IT_SHOULD : FORKED;
}

static int in_a_child(int (*act)(void))
{
    char folder[] = "/tmp/crashpulse-test-XXXXXX", command[128];
    assert_non_null(mkdtemp(folder));
    snprintf(command, sizeof command,
             "cd %s && mkdir -p in/below out && echo x >out/there && touch out/given && ln -s "
             "../out/new in/link",
             folder);
    assert_int_equal(system(command), 0);
    int ended = 0;
    pid_t child = fork();
    if (child == 0)
        _exit(chdir(folder) == 0 ? act() : -1);
    assert_int_equal(waitpid(child, &ended, 0), child);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
    return WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
}

static void writes_stay_in_folders_and_no_socket_opens(void **state)
{
    (void)state;
    if (!cp_confinement_has_folders())
        print_message("SKIPPED: no Landlock here, only sockets are looked at\n");
    assert_int_equal(in_a_child(what_is_left), AS_IT_SHOULD);
}

static void what_is_forked_is_confined_too(void **state)
{
    (void)state;
    assert_int_equal(in_a_child(of_child_of_child), AS_IT_SHOULD);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(writes_stay_in_folders_and_no_socket_opens),
        cmocka_unit_test(what_is_forked_is_confined_too),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
