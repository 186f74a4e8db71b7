// SPDX-License-Identifier: AGPL-3.0-or-later
// What failed in the chosen job: POV-Ray's own line, and the end of its output.
import { byId, el, moment, plural, say } from "./text.js";

let shown = "";

function row(f, job) {
	const where = [job.animation ? `frame ${f.frame}` : "", job.strips_per_frame > 1 ? `from row ${f.row + 1}` : ""].filter(Boolean).join(", ") || "the picture";
	const item = el("li", {}, el("div", { class: "quiet" }, `${moment(f.when)}, ${where}, on ${f.worker}`), el("p", { class: "error" }, f.line));
	if (f.log)
		item.append(el("details", {}, el("summary", {}, "POV-Ray's output"), el("pre", { tabindex: "0" }, f.log)));
	return item;
}

/** Asks again only when something has failed since. */
export async function drawFailures(model) {
	const job = model.chosen;
	const version = job ? `${job.id} ${job.created} ${job.stage} ${model.failures}` : "";
	if (version === shown)
		return;
	shown = version;
	const box = byId("failures");
	let list = [];
	if (job)
		try {
			const answer = await fetch(`/v1/jobs/${job.id}/log`);
			list = answer.ok ? (await answer.json()).failures : [];
		} catch { // with the next failure, or the next connection
		}
	if (version !== shown)
		return;
	box.hidden = !list.length;
	say(byId("failure-count"), plural(list.length, "strip that failed", "strips that failed"));
	const stage = `${job?.id} ${job?.stage}`;
	if (box.dataset.stage !== stage)
		box.open = job?.stage === "failed";
	box.dataset.stage = stage;
	const latest = list.slice(-50).reverse();
	byId("failure-rows").replaceChildren(...latest.map(f => row(f, job)));
}
