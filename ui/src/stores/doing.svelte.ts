/** The goals and the recipes that there are, and what is known of one in advance. */

import type { Diagnostic } from "../api/client";
import type { Diagnostics } from "../api/documents";
import { desk } from "./desk.svelte";
import type { Ahead, Goals } from "./goals";
import type { Foreseen, Listing } from "./recipes";

class Seeking {
  all = $state.raw<Goals | null>(null);
  ahead = $state.raw<Ahead | null>(null);

  async look(): Promise<void> {
    this.all = (await desk.read<Goals>("pico.goals/v1", "optimize")) ?? this.all;
  }

  async dry(words: string[]): Promise<void> {
    this.ahead = null;
    this.ahead = await desk.read<Ahead>("pico.goal/v1", ...words, "--dry-run");
  }
}

export const seeking = new Seeking();

class Recipes {
  all = $state.raw<Listing | null>(null);
  ahead = $state.raw<Foreseen | null>(null);
  wrong = $state.raw<Diagnostic[]>([]);
  checked = $state("");

  async look(): Promise<void> {
    this.all = (await desk.read<Listing>("pico.recipes/v1", "recipe", "list")) ?? this.all;
  }

  async check(name: string, words: string[]): Promise<void> {
    const answer = await desk.run(["recipe", "check", name, ...words]);
    const found = (schema: string) => answer.said.find((one) => "schema" in one && one.schema === schema);
    this.ahead = (found("pico.recipe_ahead/v1") as unknown as Foreseen | undefined) ?? null;
    this.wrong = [...((found("pico.diagnostics/v1") as unknown as Diagnostics | undefined)?.diagnostics ?? []), ...(this.ahead ? [] : answer.diagnostics)];
    this.checked = [name, ...words].join(" ");
  }
}

export const recipes = new Recipes();
