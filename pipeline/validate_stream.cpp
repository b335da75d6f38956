// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/validate_stream.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "pipeline/indoor/cells.h"
#include "pipeline/instances.h"

namespace watertight::pipeline {
namespace {

/// If the document is a single feature, all threads help within it.
CertifyOptions certify_options(const formats::FeatureReader& reader, const StreamOptions& options) {
  CertifyOptions certify = options.certify;
  if (reader.feature_count() == std::size_t{1}) {
    certify.threads = static_cast<unsigned>(std::clamp<std::size_t>(options.threads, 1, 256));
  }
  return certify;
}

class Stream {
 public:
  Stream(formats::FeatureReader& reader, delaunay::EngineWorkers* workers,
         const StreamOptions& options, const FeatureSink& on_feature, const ErrorSink& on_error)
      : reader_(reader),
        workers_(workers),
        options_(options),
        certify_(certify_options(reader, options)),
        on_feature_(on_feature),
        on_error_(on_error),
        templates_(reader.document().templates, workers, certify_,
                   group_options(options.groups, certify_)),
        cells_(reader.document(), workers, certify_, options.groups, options.threads,
               options.is_cancelled) {}

  Result<StreamOutcome> run() {
    FeatureStreamOptions stream{options_.threads, options_.is_cancelled, {}};
    if (options_.progress) {
      stream.progress = [this](std::uint64_t bytes) {
        options_.progress(outcome_.features, bytes);
      };
    }
    const FeatureWork work = [this](std::uint64_t number, const formats::FeatureText& text,
                                    Result<Feature> feature) {
      return validate(number, text, std::move(feature));
    };
    const auto count = stream_features(reader_, stream, work);
    if (!count) return count.error();
    if (Status status = add_templates(*count); !status) return status.error();
    return outcome_;
  }

 private:
  Delivery validate(std::uint64_t number, const formats::FeatureText& text,
                    Result<Feature> feature) {
    if (!feature) {
      return [this, error = std::move(feature).error()]() -> Status {
        ++outcome_.unreadable;
        return on_error_(error);
      };
    }
    Delivery prepared = options_.prepare ? options_.prepare(text, *feature) : Delivery();
    const auto validated = std::make_shared<ValidatedFeature>(ValidatedFeature{
        number,
        inspect(*std::move(feature), workers_, certify_, options_.groups, &templates_, &cells_),
        text.place});
    return [this, validated, prepared = std::move(prepared)] {
      Status status = prepared ? prepared() : Done{};
      return status ? hand_on(std::move(*validated)) : status;
    };
  }

  Status hand_on(ValidatedFeature feature) {
    ++outcome_.features;
    outcome_.verdict = worse(outcome_.verdict, feature.inspected.verdict());
    return on_feature_(std::move(feature));
  }

  /// Hands on the geometry templates, last because what they count as depends on their instances.
  Status add_templates(std::uint64_t number) {
    auto inspected = templates_.inspect_templates(reader_.document().instances,
                                                  reader_.document().template_surfaces);
    if (!inspected) return Done{};
    return hand_on({number, *std::move(inspected), {}});
  }

  formats::FeatureReader& reader_;
  delaunay::EngineWorkers* workers_;
  const StreamOptions& options_;
  const CertifyOptions certify_;
  const FeatureSink& on_feature_;
  const ErrorSink& on_error_;
  TemplateInspector templates_;
  CellInspector cells_;
  StreamOutcome outcome_;  // only deliveries change it
};

}  // namespace

Result<StreamOutcome> validate_stream(formats::FeatureReader& reader,
                                      delaunay::EngineWorkers* workers,
                                      const StreamOptions& options, const FeatureSink& on_feature,
                                      const ErrorSink& on_error) {
  return Stream(reader, workers, options, on_feature, on_error).run();
}

}  // namespace watertight::pipeline
