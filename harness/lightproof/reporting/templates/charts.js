"use strict";
for (const chart of document.querySelectorAll(".chart")) {
  const specification = JSON.parse(chart.nextElementSibling.textContent);
  vegaEmbed(chart, specification, { actions: false, renderer: "svg", tooltip: { theme: "custom" } })
    .catch((error) => { chart.textContent = `This chart could not be drawn: ${error}`; console.error(error); });
}
