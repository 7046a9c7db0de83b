/** What the palette and the keys do. */

import { address, TABS } from "./address.svelte";
import { bench } from "./bench.svelte";
import { desk } from "./desk.svelte";
import { hand } from "./hand.svelte";
import { session } from "./session.svelte";
import { theme } from "./theme.svelte";

export interface Action { title: string; key?: string; barred?: string | null; run(): void }

const DOINGS = [["steer", "Steer by hand"], ["measure", "Measure with a camera"], ["optimize", "Optimize: seek a goal"], ["recipes", "Recipes: check and run one"]] as const;

/** All that can be done now. */
export function actions(): Action[] {
  const yours = bench.token !== null;
  return [
    { title: "STOP at once", key: "Ctrl .", run: () => void bench.stop() },
    { title: "Stop safely: nothing more starts", run: () => void bench.halt() },
    ...TABS.map((tab, i) => ({ title: `Show ${tab}`, key: String(i + 1), run: () => address.go(tab) })),
    ...DOINGS.map(([act, title]) => ({ title, run: () => address.go("do", { act }) })),
    { title: "Plan for the manifest", run: () => { address.go("plan", { rev: "" }); void desk.think(["plan"]); } },
    { title: "Look anew (status)", key: "R", run: () => void desk.look() },
    { title: yours ? "Give the bench back" : "Take the bench", barred: session.may("operator", bench.lab) ? null : "needs the role operator",
      run: () => void (yours ? bench.release() : bench.take()) },
    { title: hand.on ? "End editing by hand" : "Edit by hand: drag and turn components", barred: hand.barred, run: hand.turn },
    { title: theme.shown === "dark" ? "Light colours" : "Dark colours", run: theme.turn },
    ...(bench.scene?.components ?? []).map((one) => ({ title: `Component ${one.name}`, run: () => address.go("inspect", { part: one.name }) })),
    ...(desk.log?.commits ?? []).flatMap((one) => one.refs).map((ref) => ({
      title: `Plan ${ref}`, run: () => { address.go("plan", { rev: ref }); void desk.think(["plan", ref]); } })),
    ...(desk.status && desk.status.backend !== "hardware" ? (bench.scene?.components ?? []) : []).filter((one) => one.movable).map((one) => ({
      title: `Simulator: push ${one.name} by 5 mm`, barred: bench.barred,
      run: () => void desk.did(["sim", "nudge", one.name, "--dx", "5"]) })),
    { title: "Log out", run: () => void session.leave() },
  ];
}

/** What a key does where nothing is typed into; null for one that does nothing. */
export function keyed(event: KeyboardEvent, palette: () => void): (() => void) | null {
  const typing = event.target instanceof HTMLElement && event.target.matches("input:not([type=checkbox]), textarea, select");
  const ctrl = event.ctrlKey || event.metaKey;
  if (ctrl && event.key === ".") return () => void bench.stop();
  if (ctrl && event.key.toLowerCase() === "k") return palette;
  if (typing || ctrl || event.altKey) return null;
  const elsewhere = event.target instanceof HTMLElement && event.target.closest(event.key === "Enter" ? "button, summary, dialog" : "[data-row], [role=tablist], dialog");
  const does = elsewhere ? null : hand.key(event);
  if (does) return does;
  const tab = TABS[Number(event.key) - 1];
  if (tab) return () => address.go(tab);
  if (event.key === "/") return () => document.getElementById("filter")?.focus();
  if (event.key.toLowerCase() === "r") return () => void desk.look();
  return null;
}
