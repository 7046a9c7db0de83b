/** Light or dark: as the machine has it, until somebody says otherwise. */
class Theme {
  #said = $state<string | null>(localStorage.getItem("pico-theme"));
  #dark = $state(matchMedia("(prefers-color-scheme: dark)").matches);

  constructor() {
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", (event) => (this.#dark = event.matches));
    this.#show();
  }

  get shown(): "light" | "dark" { return this.#said === "dark" || (this.#said === null && this.#dark) ? "dark" : "light"; }

  turn = (): void => {
    this.#said = this.shown === "dark" ? "light" : "dark";
    localStorage.setItem("pico-theme", this.#said);
    this.#show();
  };

  #show(): void {
    if (this.#said) document.documentElement.dataset.theme = this.#said;
  }
}

export const theme = new Theme();
