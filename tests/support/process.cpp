#include "tests/support/process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace vantage::test {
namespace {

[[noreturn]] void becomeProgram(const std::vector<std::string>& words, const ProcessOptions& options) {
  for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(126);
  if (options.file_size_limit > 0) {
    const rlimit limit{options.file_size_limit, options.file_size_limit};
    setrlimit(RLIMIT_FSIZE, &limit);
    signal(SIGXFSZ, SIG_IGN);  // writes fail with EFBIG instead
  }
  if (options.memory_limit > 0) {
    const rlimit limit{options.memory_limit, options.memory_limit};
    setrlimit(RLIMIT_AS, &limit);
  }
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  execv(argv[0], argv.data());
  _exit(127);
}

[[noreturn]] void becomeChild(const std::vector<std::string>& words, const ProcessOptions& options,
                              const int in[2], const int out[2], const int err[2]) {
  dup2(in[0], STDIN_FILENO);
  dup2(out[1], STDOUT_FILENO);
  dup2(err[1], STDERR_FILENO);
  for (const int* pipe : {in, out, err}) {
    close(pipe[0]);
    close(pipe[1]);
  }
  becomeProgram(words, options);
}

}  // namespace

ProcessResult runProcess(const std::vector<std::string>& words, const ProcessOptions& options) {
  int in[2], out[2], err[2];
  if (pipe(in) != 0 || pipe(out) != 0 || pipe(err) != 0) throw std::runtime_error("no pipes");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) becomeChild(words, options, in, out, err);
  close(in[0]);
  close(out[1]);
  close(err[1]);
  // Inputs of the tests are smaller than a pipe's buffer.
  if (!options.input.empty() && write(in[1], options.input.data(), options.input.size()) < 0)
    throw std::runtime_error("cannot write to the child");
  close(in[1]);

  ProcessResult result;
  std::array<pollfd, 2> fds = {pollfd{out[0], POLLIN, 0}, pollfd{err[0], POLLIN, 0}};
  const auto start = std::chrono::steady_clock::now();
  bool interrupted = options.interrupt_after_s <= 0.0;
  while (fds[0].fd >= 0 || fds[1].fd >= 0) {
    poll(fds.data(), fds.size(), 50);
    const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!interrupted && elapsed_s > options.interrupt_after_s) {
      kill(child, SIGINT);
      interrupted = true;
    }
    for (pollfd& fd : fds) {
      if (fd.fd < 0 || fd.revents == 0) continue;
      char buffer[65536];
      const ssize_t count = read(fd.fd, buffer, sizeof buffer);
      if (count > 0) {
        (&fd == &fds[0] ? result.out : result.err).append(buffer, static_cast<std::size_t>(count));
      } else {
        close(fd.fd);
        fd.fd = -1;
      }
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

BackgroundProcess::BackgroundProcess(const std::vector<std::string>& words, const ProcessOptions& options)
    : child_(fork()) {
  if (child_ < 0) throw std::runtime_error("no process");
  if (child_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // it must not outlive a test that was killed
    becomeProgram(words, options);
  }
}

BackgroundProcess::~BackgroundProcess() {
  if (!running()) return;
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

bool BackgroundProcess::running() const {
  if (child_ > 0 && waitpid(child_, nullptr, WNOHANG) == child_) child_ = -1;
  return child_ > 0;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "vantage-test-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string readFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void writeFile(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace vantage::test
