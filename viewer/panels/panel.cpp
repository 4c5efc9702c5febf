#include "viewer/panels/panel.h"

#include "viewer/panels/plot.h"

namespace vantage {

void emptyText(PanelContext& context, const std::string& name, const std::string& hint) {
  const bool loading = context.model.loading();
  faintText(context.theme, loading ? "loading…" : hint);
  context.widgets.note(name + (loading ? "/loading" : "/empty"));
}

}  // namespace vantage
