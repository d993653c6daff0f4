// boxwood trace: rays from a NumPy file through a mesh, hits into another.
#include <algorithm>
#include <vector>

#include "boxwood/io.h"
#include "boxwood/render.h"
#include "commands.h"
#include "input.h"
#include "pipeline.h"
#include "progress.h"
#include "ray_file.h"
#include "session.h"
#include "text.h"

namespace boxwood::program {
namespace {

struct TraceOptions {
  CommonOptions common;
  PipelineOptions pipeline;
  InputOptions input_options;
  std::string input, rays, output;
  std::string query = "closest";
  std::string mode = "robust";
};

constexpr std::size_t kBlock = std::size_t{1} << 20;  // rays between two looks at the progress bar

struct Answers {
  std::vector<Hit> hits;
  std::vector<std::uint8_t> occluded;
  double seconds = 0;

  std::size_t hit_count() const {
    const auto hit = std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.is_hit(); });
    return static_cast<std::size_t>(hit + std::count(occluded.begin(), occluded.end(), 1));
  }
};

Result<Answers> ask(const Accel& accel, std::span<const Ray> rays, bool any, queries::Mode mode,
                    const Session& session) {
  Answers answers;
  if (any)
    answers.occluded.resize(rays.size());
  else
    answers.hits.resize(rays.size());
  Progress progress("tracing", session.shows_progress());
  for (std::size_t begin = 0; begin < rays.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, rays.size() - begin);
    const auto block = rays.subspan(begin, count);
    const double start = now();
    const Status status = any ? accel.any_hits(block, std::span(answers.occluded).subspan(begin, count), mode)
                              : accel.closest_hits(block, std::span(answers.hits).subspan(begin, count), {}, mode);
    if (!status) return status.error();
    answers.seconds += now() - start;
    progress.update(static_cast<double>(begin + count) / static_cast<double>(rays.size()));
  }
  return answers;
}

Status write_answers(const std::string& path, const Answers& answers, bool any) {
  if (any) return io::write_occlusion(path, answers.occluded);
  std::vector<io::HitRecord> records(answers.hits.size());
  std::transform(answers.hits.begin(), answers.hits.end(), records.begin(), [](const Hit& h) {
    return io::HitRecord{h.t, h.u, h.v, h.primitive};
  });
  return io::write_hits(path, records);
}

Status run_trace(const TraceOptions& options) {
  const Session session("trace", options.common);
  const bool any = options.query == "any";
  const auto mode = queries::find_mode(options.mode);
  if (!mode) return mode.error();
  for (const std::string& path : {options.output, options.common.json})
    if (Status status = check_output_folder(path); !status) return status;
  const auto rays = read_ray_file(options.rays);
  if (!rays) return rays.error();
  const auto input = load_usable_input(options.input, options.input_options, session);
  if (!input) return input.error();
  const auto pipeline = run_pipeline(*input, options.pipeline, session);
  if (!pipeline) return pipeline.error();
  const auto answers = ask(pipeline->accel, *rays, any, *mode, session);
  if (!answers) return answers.error();
  if (Status status = write_answers(options.output, *answers, any); !status) return status;

  const double mrays = answers->seconds > 0 ? 1e-6 * static_cast<double>(rays->size()) / answers->seconds : 0;
  const std::uint64_t ray_hash = render::hash(*rays);
  session.note("rays: {}, hash {}, {} query, {} mode\n", options.rays, hash_text(ray_hash), options.query,
               options.mode);
  session.result("{} rays, {} hits, {:.2f} Mrays/s, written to {}\n", with_thousands(rays->size()),
                 with_thousands(answers->hit_count()), mrays, options.output);
  Json report = session.report(pipeline->accel.isa());
  report["mesh"] = input->json();
  report["options"] = options_json(pipeline->echo);
  report["options"]["query"] = options.query;
  report["options"]["mode"] = options.mode;
  report["excluded"] = pipeline->excluded;
  report["references"] = pipeline->accel.reference_count();
  report["build_ms"] = 1e3 * pipeline->build_seconds;
  report["rays_file"] = options.rays;
  report["rays"] = rays->size();
  report["ray_hash"] = hash_text(ray_hash);
  report["hits"] = answers->hit_count();
  report["trace_ms"] = 1e3 * answers->seconds;
  report["mrays"] = mrays;
  report["output"] = options.output;
  return session.finish(report);
}

}  // namespace

void add_trace_command(CLI::App& program, Run& run) {
  auto options = std::make_shared<TraceOptions>();
  CLI::App& command = *program.add_subcommand("trace", "Trace rays from a NumPy file, write the hits to another");
  command.add_option("INPUT", options->input, kInputHelp)->required()->type_name("");
  options->input_options.add_to(command);
  command.add_option("-r,--rays", options->rays, "float32 array, (N,6) ox oy oz dx dy dz or (N,8) with tmin tmax")
      ->type_name("RAYS.npy")
      ->required();
  command.add_option("-o,--output", options->output, "Where the hits go: fields t u v primitive, or bool for any")
      ->type_name("HITS.npy")
      ->required();
  command.add_option("--query", options->query, "closest or any hit")
      ->check(CLI::IsMember({"closest", "any"}))
      ->capture_default_str();
  command.add_option("--mode", options->mode, "robust (watertight) or fast")
      ->check(CLI::IsMember({"robust", "fast"}))
      ->capture_default_str();
  options->pipeline.add_to(command);
  options->common.add_to(command);
  command.footer(
      "\nExamples:\n"
      "  boxwood trace bunny.ply --rays rays.npy -o hits.npy\n"
      "  boxwood trace bunny.ply --rays shadow_rays.npy -o occluded.npy --query any --mode fast\n\n"
      "Directions need not have unit length; t is in units of their length. A miss has t = inf and primitive "
      "4294967295.");
  command.callback([options, &run] { run = [options] { return run_trace(*options); }; });
}

}  // namespace boxwood::program
