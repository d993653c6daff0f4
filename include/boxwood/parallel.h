// Where the work runs. Every parallel function of the library takes an Executor; there is no global pool.
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace boxwood {

/// A non-owning reference to something callable; it must outlive the call it is passed to.
template <class Signature>
class FunctionRef;
template <class R, class... Args>
class FunctionRef<R(Args...)> {
 public:
  template <class F>
  requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef>) FunctionRef(F&& f)
  noexcept
      : object_(const_cast<void*>(static_cast<const void*>(&f))), call_([](void* object, Args... args) -> R {
          return (*static_cast<std::remove_reference_t<F>*>(object))(static_cast<Args>(args)...);
        }) {}
  R operator()(Args... args) const { return call_(object_, static_cast<Args>(args)...); }

 private:
  void* object_;
  R (*call_)(void*, Args...);
};

/// Runs pieces of work. Implement it to bring your own thread pool; the results of the library do not depend on it,
/// because work is cut by item count only and joined in index order. Implementations must be usable from several
/// threads and from inside their own work.
class Executor {
 public:
  virtual ~Executor() = default;
  /// Calls f(chunk, begin, end) once for each chunk [chunk * chunk_size, min(count, ...)) of [0, count), in any order,
  /// and returns when all are done. chunk_size >= 1. The first exception thrown by f is rethrown here.
  virtual void for_chunks(std::size_t count, std::size_t chunk_size,
                          FunctionRef<void(std::size_t chunk, std::size_t begin, std::size_t end)> f) = 0;
  /// Calls both, possibly at the same time, and returns when both are done.
  virtual void invoke(FunctionRef<void()> a, FunctionRef<void()> b) = 0;
  /// How many threads it may use at once, at least 1.
  virtual int threads() const noexcept = 0;
};

/// Runs everything on the calling thread, in index order.
class SequentialExecutor final : public Executor {
 public:
  void for_chunks(std::size_t count, std::size_t chunk_size,
                  FunctionRef<void(std::size_t, std::size_t, std::size_t)> f) override;
  void invoke(FunctionRef<void()> a, FunctionRef<void()> b) override;
  int threads() const noexcept override { return 1; }
};

/// Runs on a oneTBB arena of its own, which changes nothing for other users of oneTBB in the process.
/// `threads` = 0 takes every processor the process may run on; more threads than oneTBB's own limit allows are
/// created only when the program has raised that limit (tbb::global_control).
class ThreadExecutor final : public Executor {
 public:
  explicit ThreadExecutor(int threads = 0);
  ~ThreadExecutor() override;
  void for_chunks(std::size_t count, std::size_t chunk_size,
                  FunctionRef<void(std::size_t, std::size_t, std::size_t)> f) override;
  void invoke(FunctionRef<void()> a, FunctionRef<void()> b) override;
  int threads() const noexcept override;

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

}  // namespace boxwood
